// A figure says its values in <title>s; shown at once, beside the pointer, they read better.
(() => {
  const tip = document.getElementById("tip");
  let title = null, text = "";
  const leave = () => {
    if (title) title.textContent = text;
    title = null;
    tip.hidden = true;
  };
  document.addEventListener("pointerover", (event) => {
    leave();
    const mark = event.target.closest(".hover > *");
    title = mark && mark.querySelector("title");
    if (!title) return;
    text = title.textContent;
    title.textContent = "";
    tip.textContent = text;
    tip.hidden = false;
  });
  document.addEventListener("pointermove", (event) => {
    const room = (at, size, whole) => Math.max(4, Math.min(at + 14, whole - size - 4));
    tip.style.left = room(event.clientX, tip.offsetWidth, innerWidth) + "px";
    tip.style.top = room(event.clientY, tip.offsetHeight, innerHeight) + "px";
  });
  document.addEventListener("pointerleave", leave);
})();
