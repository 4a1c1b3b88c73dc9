// Figures and tables as files: made when they are asked for, of what the page shows.
(() => {
  const save = (blob, name) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  const offer = (after, what, go) => {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "download";
    button.textContent = what;
    button.addEventListener("click", go);
    after.append(button);
  };
  const title = document.querySelector("h1").textContent.replace(/[^\w-]+/g, "-");
  // Pixels of a picture per unit of its drawing: sharp in print at half the width of a page.
  const SCALE = 3;
  document.querySelectorAll("figure").forEach((figure, k) => {
    const svg = figure.querySelector("svg");
    if (!svg) return;
    const name = title + "-figure-" + (k + 1);
    const drawing = () => {
      const copy = svg.cloneNode(true);
      copy.setAttribute("xmlns", "http:" + "//www.w3.org/2000/svg");
      return new XMLSerializer().serializeToString(copy);
    };
    offer(figure, "Figure as SVG", () => save(new Blob([drawing()], { type: "image/svg+xml" }), name + ".svg"));
    offer(figure, "as PNG", () => {
      const { width, height } = svg.viewBox.baseVal;
      const image = new Image(SCALE * width, SCALE * height);
      image.addEventListener("load", () => {
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [image.width, image.height];
        const paper = canvas.getContext("2d");
        paper.fillStyle = "white";
        paper.fillRect(0, 0, canvas.width, canvas.height);
        paper.drawImage(image, 0, 0, canvas.width, canvas.height);
        canvas.toBlob((blob) => save(blob, name + ".png"));
      });
      image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(drawing());
    });
  });
  document.querySelectorAll("table").forEach((table, k) => {
    const cell = (of) => {
      const text = of.textContent.trim();
      // A spreadsheet runs what begins like a formula.
      const safe = /^[=@\t]|^[+-](?![\d.])/.test(text) ? "'" + text : text;
      return /[",\n]/.test(safe) ? '"' + safe.replaceAll('"', '""') + '"' : safe;
    };
    const rows = () => [...table.rows].map((row) => [...row.cells].map(cell).join(",") + "\n").join("");
    const scroll = table.closest(".scroll");
    const below = scroll.parentElement.insertBefore(document.createElement("div"), scroll.nextSibling);
    const file = title + "-table-" + (k + 1) + ".csv";
    offer(below, "Table as CSV", () => save(new Blob([rows()], { type: "text/csv" }), file));
  });
})();
