// What is wider than the window fades where it goes on, and says so: a bar to scroll with is not always seen.
(() => {
  for (const part of document.querySelectorAll(".scroll")) {
    const hint = document.createElement("p");
    hint.className = "wider";
    hint.textContent = "Wider than the window: scroll sideways.";
    part.before(hint);
    const look = () => {
      const hidden = part.scrollWidth - part.clientWidth;
      hint.hidden = hidden < 2;
      part.classList.toggle("more-left", part.scrollLeft > 1);
      part.classList.toggle("more-right", part.scrollLeft < hidden - 1);
    };
    part.addEventListener("scroll", look, { passive: true });
    new ResizeObserver(look).observe(part);
    look();
  }
})();
