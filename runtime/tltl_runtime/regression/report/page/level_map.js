// Draws onto the map of a level: the trajectories of all episodes, heat maps, or one moment of an episode.

const MARKS = {
  success: { name: "succeeded", path: "M0,-6L6,0L0,6L-6,0Z" },
  violation: { name: "broke the spec", path: "M-5,-7L0,-2L5,-7L7,-5L2,0L7,5L5,7L0,2L-5,7L-7,5L-2,0L-7,-5Z" },
  limit: { name: "ran out of time", path: "M-5,-5H5V5H-5Z" },
};
const RAYS = 48;

/** Appends a new SVG element to `parent`, and returns it. */
function draw(parent, name, attributes = {}, title = "") {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (title) draw(element, "title").textContent = title;
  parent.append(element);
  return element;
}

/** The nodes of a sentence; text between backquotes becomes `code`. */
function prose(text) {
  return text.split(/`([^`]+)`/).map((part, place) => {
    if (place % 2 === 0) return document.createTextNode(part);
    const code = document.createElement("code");
    code.textContent = part;
    return code;
  });
}

/** The nodes of the label of a state: in words and, if it differs, in symbols. The page shows one of the two. */
function label({ states, symbols }, state) {
  if (states[state] === symbols[state]) return prose(states[state]);
  return [["in-words", states], ["in-symbols", symbols]].map(([kind, texts]) => {
    const span = document.createElement("span");
    span.className = kind;
    span.append(...prose(texts[state]));
    return span;
  });
}

/** A number with three significant digits, or as a whole number if it has more digits. */
function threeDigits(value) {
  return Math.abs(value) < 1000 ? value.toPrecision(3) : value.toFixed(0);
}

class LevelMap {
  /** `svg` is the map, `facts` the data of its level, `colours` the colours of the automaton's states. */
  constructor(svg, facts, colours) {
    this.svg = svg;
    this.facts = facts;
    this.colours = colours;
    this.layers = Object.fromEntries(
      ["heat", "trajectories", "ends", "live"].map((name) => [name, svg.querySelector(`g.${name}`)]),
    );
    this.barriers = [...svg.querySelectorAll(".barrier")];
    this.switches = [...svg.querySelectorAll(".switch")];
    // Letters and lines keep their size on the screen: --unit is the number of centimetres per pixel.
    new ResizeObserver(() => svg.style.setProperty("--unit", 1 / (svg.getScreenCTM()?.a || 1))).observe(svg);
  }

  clear() {
    for (const layer of Object.values(this.layers)) layer.replaceChildren();
    for (const element of [...this.barriers, ...this.switches]) element.classList.remove("open", "active");
  }

  /**
   * Draws the trajectories of episodes, coloured by state, with marks where they ended.
   * `link` maps the index of an episode to its address, or to "".  Returns the set of the states whose colours are drawn.
   */
  showTrajectories(trajectories, link) {
    this.clear();
    const drawn = new Set();
    const opacity = Math.max(0.15, Math.min(0.9, 6 / Math.max(1, trajectories.length)));
    for (const trajectory of trajectories) {
      const { x, y, unit } = trajectory;
      const [xs, ys] = [x, y].map((packed) => unstepped(packed).map((value) => value * unit));
      let from = 0;
      for (const [state, count] of trajectory.state) {
        const to = Math.min(from + count, xs.length - 1);
        if (to > from) drawn.add(state);
        this.#line(this.layers.trajectories, xs.slice(from, to + 1), ys.slice(from, to + 1), state, opacity);
        from += count;
      }
    }
    for (const trajectory of trajectories) {
      const by = trajectory.by.length ? `, ${trajectory.by.join(", ")}` : "";
      const address = link(trajectory.index);
      const place = trajectory.place.flatMap(unstepped);
      const mark = this.#mark(trajectory.end, place, `episode ${trajectory.index}: ${trajectory.cause}${by}`, address);
      if (!address) mark.classList.add("unrecorded");
    }
    return drawn;
  }

  /** Draws a heat map; `most` is the value of the strongest colour, `unit` that of times. */
  showHeat(heat, most, kind, unit) {
    this.clear();
    for (let place = 0; place < heat.cells.length; place += 2) {
      const index = heat.cells[place];
      const value = heat.cells[place + 1];
      const words = kind === "time" ? `${value < 0.01 ? "under 0.01" : value.toFixed(2)} ${unit} an episode` : `${value} failed here`;
      draw(
        this.layers.heat,
        "rect",
        {
          class: `cell ${kind}`,
          x: (index % heat.columns) * heat.cell,
          y: Math.floor(index / heat.columns) * heat.cell,
          width: heat.cell,
          height: heat.cell,
          "fill-opacity": (0.12 + 0.8 * Math.sqrt(value / most)).toFixed(3),
        },
        words,
      );
    }
  }

  /** Draws the moment of `row` of an unpacked episode; `share`, in [0, 1), is how far it is to the next row. */
  showMoment(episode, row, share) {
    this.clear();
    const next = Math.min(row + 1, episode.time.length - 1);
    const between = (values) => values[row] + share * (values[next] - values[row]);
    const live = this.layers.live;
    this.barriers.forEach((barrier, place) => barrier.classList.toggle("open", episode.open[place][row] === 1));
    this.switches.forEach((element, place) => element.classList.toggle("active", episode.active[place][row] === 1));
    this.#trail(episode, row);
    episode.movers.forEach((mover, place) => {
      const [width, height] = this.facts.movers[place].sides;
      const corner = { x: between(mover.x) - width / 2, y: between(mover.y) - height / 2 };
      draw(live, "rect", { class: "mover", ...corner, width, height });
    });
    const moving = episode.movers.map((mover, place) => this.#moverBlock(place, between(mover.x), between(mover.y)));
    const enemies = episode.enemies.map((enemy, place) => ({
      facts: this.facts.enemies[place],
      x: between(enemy.x),
      y: between(enemy.y),
      yaw: between(enemy.yaw),
      mode: enemy.mode[row],
      sees: enemy.sees[row] === 1,
    }));
    const shut = episode.open.map((barrier) => barrier[row] === 0);
    for (const enemy of enemies) {
      draw(live, "polygon", { class: `cone${enemy.sees ? " sees" : ""}`, points: this.#cone(enemy, shut, moving) });
    }
    for (const enemy of enemies) {
      const words = `${enemy.facts.name}: ${enemy.mode}${enemy.sees ? ", sees the player" : ""}`;
      this.#body(enemy, `enemy ${enemy.mode}`, 35, "", words);
      draw(live, "text", { x: enemy.x, y: enemy.y - 45 }).textContent = enemy.facts.name;
    }
    for (const entity of episode.entities) {
      if (!entity.there[row]) continue;
      // An entity that is gone at the next row does not move towards its place at another time.
      const place = entity.there[next] ? { x: between(entity.x), y: between(entity.y) } : { x: entity.x[row], y: entity.y[row] };
      this.#body(place, "entity", 25, "", entity.name);
      draw(live, "text", { x: place.x, y: place.y - 35 }).textContent = entity.name;
    }
    const { player } = episode;
    const crouches = player.crouching?.[row] === 1;
    const body = { x: between(player.x), y: between(player.y), yaw: player.yaw && between(player.yaw) };
    const colour = this.colours[episode.state[row]];
    this.#body(body, "player-body", crouches ? 22 : 35, colour, crouches ? "the player, crouching" : "the player");
  }

  #trail(episode, row) {
    let from = 0;
    for (let at = 1; at <= row; at += 1) {
      if (at === row || episode.state[at] !== episode.state[from]) {
        const span = [from, at + 1];
        const { player } = episode;
        this.#line(this.layers.live, player.x.slice(...span), player.y.slice(...span), episode.state[from], 0.8);
        from = at;
      }
    }
  }

  #line(layer, xs, ys, state, opacity) {
    if (xs.length < 2) return;
    const points = xs.map((x, place) => `${x},${ys[place]}`).join(" ");
    draw(layer, "polyline", { class: "trajectory", points, stroke: this.colours[state], "stroke-opacity": opacity });
  }

  #mark(end, [x, y], title, address) {
    const parent = address ? draw(this.layers.ends, "a", { href: address, "aria-label": title }) : this.layers.ends;
    const place = draw(parent, "g", { transform: `translate(${x} ${y})` }, title);
    draw(place, "path", { class: `end ${end}`, d: MARKS[end].path });
    return place;
  }

  #body({ x, y, yaw }, kind, radius, colour, title) {
    const body = draw(this.layers.live, "g", { class: `body ${kind}` }, title);
    if (yaw !== undefined) {
      const angle = (yaw * Math.PI) / 180;
      const ahead = { x2: x + 2 * radius * Math.cos(angle), y2: y - 2 * radius * Math.sin(angle) };
      draw(body, "line", { x1: x, y1: y, ...ahead });
    }
    draw(body, "circle", { cx: x, cy: y, r: radius, ...(colour && { fill: colour }) });
  }

  /** The block of a moving obstacle at a place, as in `blocks` of the map. */
  #moverBlock(place, x, y) {
    const { sides, heights } = this.facts.movers[place];
    const [width, height] = sides;
    return [x - width / 2, y - height / 2, x + width / 2, y + height / 2, ...heights];
  }

  /** The area that an enemy sees at the height of its eyes, as points of a polygon. */
  #cone({ facts, x, y, yaw }, shut, moving) {
    const high = ([, , , , low, top]) => low < facts.eyes && facts.eyes < top;
    const shutBlocks = this.facts.barriers.filter((barrier, place) => shut[place] && barrier.kind === "solid");
    const blocks = [...this.facts.blocks, ...shutBlocks.map((barrier) => barrier.block), ...moving].filter(high);
    const points = facts.angle < 360 ? [`${x.toFixed(0)},${y.toFixed(0)}`] : [];
    for (let ray = 0; ray <= RAYS; ray += 1) {
      const angle = ((yaw + facts.angle * (ray / RAYS - 0.5)) * Math.PI) / 180;
      const direction = [Math.cos(angle), -Math.sin(angle)];
      const reach = blocks.reduce((least, block) => Math.min(least, distanceTo(block, [x, y], direction)), facts.reach);
      points.push(`${(x + reach * direction[0]).toFixed(0)},${(y + reach * direction[1]).toFixed(0)}`);
    }
    return points.join(" ");
  }
}

/** The distance at which a ray from `place` along the unit vector `direction` meets a block; Infinity if it does not. */
function distanceTo(block, place, direction) {
  let enter = 0;
  let leave = Infinity;
  for (const axis of [0, 1]) {
    const [low, high] = [block[axis] - place[axis], block[axis + 2] - place[axis]];
    if (Math.abs(direction[axis]) < 1e-9) {
      if (low > 0 || high < 0) return Infinity;
      continue;
    }
    const [first, second] = [low / direction[axis], high / direction[axis]];
    enter = Math.max(enter, Math.min(first, second));
    leave = Math.min(leave, Math.max(first, second));
  }
  return enter <= leave ? enter : Infinity;
}
