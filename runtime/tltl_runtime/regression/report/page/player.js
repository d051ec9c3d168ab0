// Plays a recorded episode: the map, the automaton, the curves and the values show the same moment of it.

class Player {
  /** `section` is the section of a case and `facts` its data.  `moved` is called with the player at each new moment. */
  constructor(section, facts, map, moved) {
    this.section = section;
    this.facts = facts;
    this.map = map;
    this.moved = moved;
    this.episode = null;
    this.row = 0;
    this.timer = 0;
    const find = (selector) => section.querySelector(`.player ${selector}`);
    this.which = find(".which");
    this.controls = find(".controls");
    this.scrub = find(".scrub");
    this.strip = find(".strip");
    this.playButton = find(".play");
    this.speed = find(".speed");
    this.moment = find(".moment");
    this.stateText = find(".state");
    this.bars = ["progress", "health"].map((name) => [name, find(`meter.${name}`), find(`meter.${name} ~ .number`)]).filter(([, meter]) => meter);
    this.atoms = [...section.querySelectorAll(".atoms tbody tr")].map((row) => [
      row,
      row.querySelector(".signed .length"),
      row.querySelector(".number"),
    ]);
    this.groups = new Map();
    for (const group of section.querySelectorAll(".automaton [data-states]")) {
      // Each state is in two pictures: one in words, one in symbols.
      for (const state of group.dataset.states.split(" ")) {
        this.groups.set(Number(state), [...(this.groups.get(Number(state)) ?? []), group]);
      }
    }
    this.curves = [...section.querySelectorAll(".curve")];
    this.cursor = section.querySelector(".cursor");
    this.#listen(find);
  }

  get last() {
    return this.episode.time.length - 1;
  }

  /** Shows episode `index` at `row`; returns false if the episode was not recorded. */
  open(index, row) {
    const packed = this.facts.episodes.find((episode) => episode.index === index);
    if (!packed) return false;
    if (this.episode?.index !== index) {
      this.pause();
      this.episode = unpackedEpisode(packed);
    }
    this.which.value = String(index);
    this.controls.hidden = false;
    this.section.classList.add("playing");
    this.scrub.max = this.last;
    this.strip.style.background = this.#stateStrip();
    for (const curve of this.curves) curve.classList.toggle("current", Number(curve.dataset.episode) === index);
    this.show(row);
    return true;
  }

  /** Closes the episode, so that the page shows all episodes again. */
  close() {
    this.pause();
    this.episode = null;
    if (!this.which) return;
    this.which.value = "";
    this.controls.hidden = true;
    this.section.classList.remove("playing");
    this.cursor.setAttribute("hidden", "hidden");
    for (const curve of this.curves) curve.classList.remove("current");
    this.#highlight(null);
  }

  /** Shows the moment of `row`, or a later one: `share`, in [0, 1), is how far it is to the next row. */
  show(row, share = 0) {
    const { episode } = this;
    this.row = Math.max(0, Math.min(this.last, row));
    this.scrub.value = String(this.row);
    const state = episode.state[this.row];
    const seconds = this.facts.unit === "s" ? `, ${threeDigits(episode.time[this.row] / 1000)} s` : "";
    this.moment.textContent = `step ${this.row} of ${this.last}${seconds}`;
    this.scrub.setAttribute("aria-valuetext", `${this.moment.textContent}, state ${state}`);
    const end = this.row < this.last ? "" : ` The end: ${episode.why}.`;
    this.stateText.replaceChildren(`State ${state}: `, ...label(this.facts, state), ...prose(end));
    this.stateText.style.setProperty("--state", this.map.colours[state]);
    const values = { progress: episode.progress[this.row] / 1000, health: (episode.health?.[this.row] ?? 0) / 100 };
    for (const [name, meter, number] of this.bars) {
      meter.value = values[name];
      number.textContent = values[name].toFixed(2);
    }
    this.atoms.forEach(([line, bar, number], place) => {
      // Atoms have no value at the moment of the reset.
      const value = this.row ? episode.atoms[place][this.row - 1] / 100 : null;
      // A bar starts in the middle and goes to the right if the atom holds; a robustness of 1 fills its half.
      const half = 50 * Math.min(1, Math.abs(value ?? 0));
      bar.style.left = `${value < 0 ? 50 - half : 50}%`;
      bar.style.width = `${half}%`;
      number.textContent = value === null ? "–" : `${value > 0 ? "+" : ""}${value.toFixed(2)}`;
      line.classList.toggle("holds", value !== null && value > 0);
      line.classList.toggle("fails", value !== null && value <= 0);
    });
    this.map.showMoment(episode, this.row, share);
    this.#highlight(state);
    this.#moveCursor(episode.time[this.row] / 1000);
    this.moved(this);
  }

  toggle() {
    if (this.timer) this.pause();
    else this.play();
  }

  play() {
    this.pause();
    if (this.row >= this.last) this.show(0);
    this.#label(true);
    const { time } = this.episode;
    let at = time[this.row];
    let before = null;
    const frame = (now) => {
      at += before === null ? 0 : (now - before) * Number(this.speed.value);
      before = now;
      let { row } = this;
      while (row < this.last && time[row + 1] <= at) row += 1;
      if (row >= this.last) {
        this.pause();
        this.show(this.last);
        return;
      }
      this.timer = requestAnimationFrame(frame);
      this.show(row, (at - time[row]) / (time[row + 1] - time[row]));
    };
    this.timer = requestAnimationFrame(frame);
  }

  pause() {
    cancelAnimationFrame(this.timer);
    this.timer = 0;
    if (this.playButton) this.#label(false);
  }

  /** Pauses at a row. */
  seek(row) {
    this.pause();
    this.show(row);
  }

  #listen(find) {
    if (!this.which) return;
    this.scrub.addEventListener("input", () => this.seek(Number(this.scrub.value)));
    this.playButton.addEventListener("click", () => this.toggle());
    find(".first").addEventListener("click", () => this.seek(0));
    find(".back").addEventListener("click", () => this.seek(this.row - 1));
    find(".on").addEventListener("click", () => this.seek(this.row + 1));
    find(".last").addEventListener("click", () => this.seek(this.last));
  }

  /** The states of the episode in order, as a gradient with sharp edges. */
  #stateStrip() {
    const { state } = this.episode;
    const stops = [];
    for (let from = 0; from < state.length; ) {
      let to = from;
      while (to < state.length && state[to] === state[from]) to += 1;
      const share = (row) => `${((100 * Math.min(row, this.last)) / this.last).toFixed(2)}%`;
      stops.push(`${this.map.colours[state[from]]} ${share(from)} ${share(to)}`);
      from = to;
    }
    return `linear-gradient(to right, ${stops.join(", ")})`;
  }

  #label(isRunning) {
    const words = isRunning ? "pause" : "play";
    this.playButton.classList.toggle("running", isRunning);
    this.playButton.title = words;
    this.playButton.setAttribute("aria-label", words);
  }

  #highlight(state) {
    const groups = this.groups.get(state);
    if (groups?.[0].classList.contains("current")) return;
    for (const other of [...this.groups.values()].flat()) other.classList.remove("current");
    if (!groups) return;
    for (const group of groups) group.classList.add("current");
    // A wide automaton scrolls within its box.  Scroll the state into view, but not the page.
    const group = groups.find((shown) => shown.getClientRects().length) ?? groups[0];
    const box = group.closest(".scroll");
    const [inner, outer] = [group.getBoundingClientRect(), box.getBoundingClientRect()];
    if (inner.left < outer.left || inner.right > outer.right) {
      box.scrollLeft += inner.left + inner.width / 2 - outer.left - outer.width / 2;
    }
  }

  #moveCursor(seconds) {
    const { left, right, seconds: most } = this.cursor.dataset;
    const x = Number(left) + (seconds / Number(most)) * (Number(right) - Number(left));
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.cursor.removeAttribute("hidden");
  }
}
