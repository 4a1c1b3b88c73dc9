// Plays the scenes of a run; what the data mean is said in reports/src/run/player.rs.
(() => {
  const root = document.getElementById("player");
  const data = JSON.parse(document.getElementById("scenes").textContent);
  const canvas = root.querySelector("canvas"), pen = canvas.getContext("2d");
  const part = (name) => root.querySelector("[name=" + name + "]");
  const [play, slider, colour, look, whole, arrow, flow] = ["play", "time", "colour", "look", "whole", "arrow", "flow"].map(part);
  const said = root.querySelector("output"), frames = data.times.length;
  let frame = 0, playing = false, began = 0;

  const unpack = async (view) => {
    const letters = atob(view.grains), packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer()), n = view.n;
    view.radius = bytes.subarray(0, n);
    const places = [0, 1, 2].map(() => new Uint16Array(n)), values = [0, 1, 2].map(() => new Uint8Array(n));
    view.scenes = data.times.map((_, f) => {
      let at = n + f * 9 * n;
      for (const place of places) {
        for (let i = 0; i < n; i++) {
          const change = bytes[at + i] | (bytes[at + n + i] << 8);
          place[i] += (change >> 1) ^ -(change & 1);
        }
        at += 2 * n;
      }
      for (const value of values) {
        for (let i = 0; i < n; i++) value[i] += bytes[at + i];
        at += n;
      }
      return { places: places.map((place) => place.slice()), values: values.map((value) => value.slice()) };
    });
  };

  const ink = () => getComputedStyle(root).color;
  const short = (value) => Number(value.toPrecision(2)).toString();

  // Room for axes and the bar of colours, and where a place in millimetres stands.
  const axes = (view) => {
    const [u, v] = whole.checked ? view.whole : view.near;
    const width = canvas.clientWidth, left = 52, right = 66, above = 26, below = 40;
    const scale = Math.min((width - left - right) / (u[1] - u[0]), 0.78 * innerHeight / (v[1] - v[0]));
    const height = Math.round(scale * (v[1] - v[0]) + above + below);
    const dense = devicePixelRatio || 1;
    canvas.style.height = height + "px";
    canvas.width = Math.round(width * dense);
    canvas.height = Math.round(height * dense);
    pen.setTransform(dense, 0, 0, dense, 0, 0);
    const at = (x, y) => [left + scale * (x - u[0]), above + scale * (v[1] - y)];
    return { u, v, scale, at, left, above, right: left + scale * (u[1] - u[0]), bottom: above + scale * (v[1] - v[0]) };
  };

  const ticks = (low, high, n) => {
    const least = (high - low) / Math.max(n, 1), power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].map((digit) => digit * power).find((step) => step >= least);
    const all = [];
    for (let k = Math.ceil(low / step); k <= Math.floor(high / step); k++) all.push(k * step);
    return all;
  };

  const drawAxes = (view, box) => {
    const sign = view.side ? -1 : 1, [low, high] = box.v;
    pen.strokeStyle = pen.fillStyle = ink();
    pen.lineWidth = 1;
    pen.globalAlpha = 0.6;
    pen.strokeRect(box.left, box.above, box.right - box.left, box.bottom - box.above);
    pen.globalAlpha = 1;
    pen.font = "12px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.textAlign = "center";
    for (const tick of ticks(box.u[0], box.u[1], (box.right - box.left) / 56)) {
      pen.fillText(tick, box.at(tick, 0)[0], box.bottom + 11);
    }
    pen.fillText("x from the axis (mm)", (box.left + box.right) / 2, box.bottom + 28);
    pen.textAlign = "right";
    const [from, to] = [sign * low, sign * high].sort((a, b) => a - b);
    for (const tick of ticks(from, to, (box.bottom - box.above) / 36)) {
      pen.fillText(tick, box.left - 6, box.at(0, sign * tick)[1]);
    }
    pen.save();
    pen.translate(11, (box.above + box.bottom) / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(view.side ? "depth (mm)" : "y from the axis (mm)", 0, 0);
    pen.restore();
  };

  const drawBar = (box) => {
    const { name, unit, top } = data.quantities[colour.selectedIndex], n = data.colours.length;
    const height = Math.min(box.bottom - box.above, 200), left = box.right + 10;
    data.colours.forEach((of, k) => {
      pen.fillStyle = of;
      pen.fillRect(left, box.above + height * (1 - (k + 1) / n), 12, height / n + 0.5);
    });
    pen.fillStyle = ink();
    pen.textAlign = "left";
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      // Round numbers below the top, each at its root.
      const value = share < 1 ? Number((top * share * share).toPrecision(1)) : top;
      const place = top > 0 ? Math.sqrt(value / top) : share;
      pen.fillText(short(value), left + 16, box.above + height * (1 - place) + (share ? 4 : -4));
    }
    pen.textAlign = "right";
    pen.fillText(name + " (" + unit + ")", Math.min(canvas.clientWidth, box.right + 66) - 2, box.above - 14);
  };

  const drawBody = (body, box) => {
    pen.beginPath();
    body.corners.forEach(([x, y], k) => pen[k ? "lineTo" : "moveTo"](...box.at(x, y)));
    pen.closePath();
    pen.fillStyle = "#5e6b7a";
    pen.fill();
    pen.strokeStyle = ink();
    pen.lineWidth = 1;
    pen.stroke();
  };

  const drawGrains = (view, box, list) => {
    const { places: [u, v], values } = view.scenes[frame], value = values[colour.selectedIndex];
    const levels = data.colours.length - 1, largest = (view.largest * box.scale) / 255;
    const disc = (i) => {
      const [px, py] = box.at(...millimetres(view, [u, v], i)), radius = view.radius[i] * largest * (view.sorted ? 1 : 0.95);
      pen.moveTo(px + radius, py);
      pen.arc(px, py, radius, 0, 2 * Math.PI);
    };
    const level = (i) => Math.round((value[i] / 255) * levels);
    if (view.sorted) {
      pen.strokeStyle = "#0006";
      pen.lineWidth = 1;
      for (const i of list) {
        pen.beginPath();
        disc(i);
        pen.fillStyle = data.colours[level(i)];
        pen.fill();
        pen.stroke();
      }
      return;
    }
    const groups = data.colours.map(() => []);
    for (const i of list) groups[level(i)].push(i);
    groups.forEach((group, k) => {
      pen.beginPath();
      group.forEach(disc);
      pen.fillStyle = data.colours[k];
      pen.fill();
    });
  };

  const millimetres = (view, [u, v], i) =>
    [view.whole[0][0] + (u[i] - view.beyond) * view.step, view.whole[1][0] + (v[i] - view.beyond) * view.step];

  // Mean velocity of the grains of each square cell (m/s, as mm/ms): central differences of the stored places. A cell
  // of fewer than two grains has none.
  const field = (view, box) => {
    const before = Math.max(frame - 1, 0), after = Math.min(frame + 1, frames - 1);
    const time = data.times[after] - data.times[before], side = Math.max(4 * view.largest, 22 / box.scale);
    const [now, from, to] = [frame, before, after].map((f) => view.scenes[f].places), cells = new Map();
    for (let i = 0; i < view.n && time > 0; i++) {
      if ([now, from, to].some(([u]) => u[i] === 65535)) continue;
      const [x, y] = millimetres(view, now, i), [x0, y0] = millimetres(view, from, i), [x1, y1] = millimetres(view, to, i);
      if (x < box.u[0] || x > box.u[1] || y < box.v[0] || y > box.v[1]) continue;
      const [column, row] = [Math.floor(x / side), Math.floor(y / side)], key = column + " " + row;
      const cell = cells.get(key) ?? { at: [(column + 0.5) * side, (row + 0.5) * side], n: 0, sum: [0, 0] };
      cell.n += 1;
      cell.sum[0] += (x1 - x0) / time;
      cell.sum[1] += (y1 - y0) / time;
      cells.set(key, cell);
    }
    const means = [...cells.values()].filter(({ n }) => n > 1);
    return { side, means: means.map(({ at, n, sum }) => ({ at, velocity: sum.map((part) => part / n) })) };
  };

  // The root of a speed, as in the colours: the slow flow far from the body would not be seen.
  const drawField = ({ side, means }, box) => {
    const fastest = Math.max(0, ...means.map(({ velocity }) => Math.hypot(...velocity)));
    for (const { at, velocity: [vx, vy] } of means) {
      const speed = Math.hypot(vx, vy), length = 0.95 * side * box.scale * Math.sqrt(speed / data.quantities[0].top);
      const [px, py] = box.at(...at), [dx, dy] = [(length * vx) / speed, (-length * vy) / speed];
      drawArrow([px - dx / 2, py - dy / 2], [dx, dy], 1.5);
    }
    return fastest;
  };

  const drawForce = ([x, y, fx, fy], box) => {
    const longest = 0.24 * (box.bottom - box.above);
    drawArrow(box.at(x, y), [(longest * fx) / data.most, (-longest * fy) / data.most], 2.5);
  };

  const drawArrow = ([px, py], [dx, dy], thick) => {
    const length = Math.hypot(dx, dy);
    if (!(length > 3)) return;
    const head = Math.min(3.6 * thick, 0.6 * length), ex = dx / length, ey = dy / length;
    const nx = px + dx - head * ex, ny = py + dy - head * ey;
    for (const [style, width] of [["#ffffff", 2 * thick], ["#000000", thick]]) {
      pen.beginPath();
      pen.moveTo(px, py);
      pen.lineTo(nx, ny);
      pen.strokeStyle = style;
      pen.lineWidth = width;
      pen.stroke();
    }
    pen.beginPath();
    pen.moveTo(px + dx, py + dy);
    pen.lineTo(nx - 0.5 * head * ey, ny + 0.5 * head * ex);
    pen.lineTo(nx + 0.5 * head * ey, ny - 0.5 * head * ex);
    pen.closePath();
    pen.fillStyle = "#000000";
    pen.fill();
    pen.strokeStyle = "#ffffff";
    pen.lineWidth = 1;
    pen.stroke();
  };

  const draw = () => {
    // On paper, and while the page is laid out anew, the canvas may have no width.
    if (canvas.clientWidth < 200) return;
    const view = data.views[look.selectedIndex], box = axes(view), { places } = view.scenes[frame];
    pen.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    pen.save();
    pen.beginPath();
    pen.rect(box.left, box.above, box.right - box.left, box.bottom - box.above);
    pen.clip();
    let list = [];
    for (let i = 0; i < view.n; i++) if (places[0][i] !== 65535) list.push(i);
    if (view.sorted) list.sort((a, b) => places[2][a] - places[2][b]);
    for (const body of [...view.bodies[frame]].sort((a, b) => (a.near ?? 1e9) - (b.near ?? 1e9))) {
      const below = body.near === null ? list.length : list.findIndex((i) => places[2][i] >= body.near);
      drawGrains(view, box, below < 0 ? list : list.slice(0, below));
      list = below < 0 ? [] : list.slice(below);
      drawBody(body, box);
    }
    drawGrains(view, box, list);
    if (view.side) {
      pen.setLineDash([5, 5]);
      pen.strokeStyle = ink();
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(...box.at(box.u[0], 0));
      pen.lineTo(...box.at(box.u[1], 0));
      pen.stroke();
      pen.setLineDash([]);
    }
    pen.strokeStyle = "#0072b2";
    pen.lineWidth = 2.5;
    for (const path of view.paths) {
      pen.beginPath();
      path.slice(0, view.frames[frame] + 1).forEach(([x, y], k) => pen[k ? "lineTo" : "moveTo"](...box.at(x, y)));
      pen.stroke();
    }
    const flows = flow.checked ? field(view, box) : null, fastest = flows && drawField(flows, box);
    if (arrow.checked) view.forces[frame].forEach((force) => drawForce(force, box));
    pen.restore();
    drawAxes(view, box);
    drawBar(box);
    const forces = view.forces[frame].map(([, , x, y]) => Math.hypot(x, y).toFixed(2) + " N");
    said.textContent = data.times[frame].toFixed(1) + " ms: depth " + data.depth[frame].toFixed(1) + " mm, speed "
      + data.speed[frame].toFixed(2) + " m/s" + (forces.length ? ", force of the bed " + forces.join(" and ") : "")
      + (flows ? "; grains move at up to " + fastest.toFixed(3) + " m/s (means over " + flows.side.toFixed(1) + " mm)" : "");
    slider.value = frame;
  };

  const show = (next) => { frame = next; draw(); };
  const LASTS = Math.max(4000, 60 * frames);
  const step = (now) => {
    if (!playing) return;
    const last = data.times[frames - 1], time = data.times[0] + ((now - began) / LASTS) * (last - data.times[0]);
    if (time >= last) { playing = false; play.textContent = "Play"; }
    let next = 0;
    while (next < frames - 1 && data.times[next + 1] <= time) next++;
    if (next !== frame) show(next);
    requestAnimationFrame(step);
  };
  play.addEventListener("click", () => {
    playing = !playing;
    play.textContent = playing ? "Pause" : "Play";
    if (frame === frames - 1) frame = 0;
    const share = (data.times[frame] - data.times[0]) / (data.times[frames - 1] - data.times[0] || 1);
    began = performance.now() - share * LASTS;
    requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => { playing = false; play.textContent = "Play"; show(Number(slider.value)); });
  for (const input of [colour, look, whole, arrow, flow]) input.addEventListener("change", draw);

  slider.max = frames - 1;
  for (const view of data.views) look.add(new Option(view.name));
  for (const { name } of data.quantities) colour.add(new Option(name));
  look.parentElement.hidden = data.views.length < 2;
  const start = data.views[0].frames.indexOf(Number(root.dataset.frame));
  Promise.all(data.views.map(unpack)).then(() => {
    show(Math.max(start, 0));
    addEventListener("resize", draw);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  }, () => { said.textContent = "This browser cannot unpack the grains; a newer one can."; });
})();
