// Tables sort by the column whose head is chosen, and the other way when it is chosen again.
(() => {
  const number = (cell) => parseFloat(cell.textContent.replace("\u2212", "-"));
  const order = (column, sign) => (a, b) => {
    const [one, other] = [a.cells[column], b.cells[column]];
    const [x, y] = [number(one), number(other)];
    const [isWord, isOther] = [x, y].map((value) => !Number.isFinite(value));
    if (!isWord && !isOther) return sign * (x - y);
    // What is no number comes last both ways; words go by the alphabet.
    return isWord && isOther ? sign * one.textContent.localeCompare(other.textContent) : isWord - isOther;
  };
  for (const table of document.querySelectorAll("table")) {
    const body = table.tBodies[0];
    if (body.rows.length < 4) continue;
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      if (head.tagName !== "TH") return;
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.textContent = head.textContent;
      button.addEventListener("click", () => {
        const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
        body.append(...[...body.rows].sort(order(column, sign)));
      });
      head.replaceChildren(button);
    });
  }
})();
