// Figures and tables as files: made when they are asked for, of what the page shows.
(() => {
  const offer = (after, what, name, kind, text) => {
    const button = document.createElement("button");
    button.type = "button";
    button.className = "download";
    button.textContent = what;
    button.addEventListener("click", () => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text()], { type: kind }));
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
    after.append(button);
  };
  const title = document.querySelector("h1").textContent.replace(/[^\w-]+/g, "-");
  document.querySelectorAll("figure").forEach((figure, k) => {
    const svg = figure.querySelector("svg");
    if (!svg) return;
    offer(figure, "Figure as SVG", title + "-figure-" + (k + 1) + ".svg", "image/svg+xml", () => {
      const copy = svg.cloneNode(true);
      copy.setAttribute("xmlns", "http:" + "//www.w3.org/2000/svg");
      return new XMLSerializer().serializeToString(copy);
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
    offer(table.closest(".scroll").parentElement.insertBefore(document.createElement("div"), table.closest(".scroll").nextSibling),
      "Table as CSV", title + "-table-" + (k + 1) + ".csv", "text/csv", rows);
  });
})();
