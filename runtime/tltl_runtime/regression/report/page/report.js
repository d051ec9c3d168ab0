// The whole page: the toggles of each case, addresses of episodes, keys, and the filter.

const WAIT_MS = 300;

class CaseView {
  constructor(facts, colours, moved) {
    this.facts = facts;
    this.section = document.getElementById(facts.slug);
    const [map, before] = [...this.section.querySelectorAll(".map")].map((svg) => new LevelMap(svg, facts.map, colours));
    // The level of the baseline has its own map if it looks different.
    this.maps = { now: map, before: before ?? map };
    this.player = new Player(this.section, facts, map, moved);
    this.legend = this.section.querySelector(".legend.shown");
    this.isDrawn = false;
    this.section.querySelector(".toggles").addEventListener("change", ({ target }) => {
      if (target.name === "notation") return;
      if (this.player.episode) history.replaceState(null, "", `#${facts.slug}`);
      this.showAll();
    });
    this.player.which?.addEventListener("change", () => {
      const { value } = this.player.which;
      location.hash = value ? `#${facts.slug}/${value}/0` : `#${facts.slug}`;
    });
  }

  /** Draws all episodes as the toggles say, unless they are drawn already. */
  drawOnce() {
    if (!this.isDrawn && !this.player.episode) this.showAll();
  }

  /** Draws all episodes as the toggles say. */
  showAll() {
    const form = new FormData(this.section.querySelector(".toggles"));
    const when = form.get("when") ?? "now";
    const shown = form.get("shown");
    this.section.dataset.when = when;
    this.player.close();
    this.isDrawn = true;
    const all = this.facts[when];
    if (shown === "trajectories") {
      const recorded = new Set(when === "now" ? this.facts.episodes.map((episode) => episode.index) : []);
      const link = (index) => (recorded.has(index) ? `#${this.facts.slug}/${index}/0` : "");
      this.#legendOfTrajectories(all, this.maps[when].showTrajectories(all.trajectories, link));
    } else {
      // Now and before have the same scale, so that their maps can be compared.
      const most = Math.max(this.facts.now[shown].most, this.facts.before[shown].most) || 1;
      this.maps[when].showHeat(all[shown], most, shown, this.facts.unit);
      const unit = shown === "time" ? `${most.toFixed(1)} ${this.facts.unit} an episode` : `${most} failed episode${most === 1 ? "" : "s"}`;
      const scope = this.facts.before.trajectories.length ? ", now or in the baseline" : "";
      const text = all[shown].cells.length ? `strongest${scope}: ${unit}` : "no episode failed";
      this.#fillLegend([[`cell ${shown}`, "", text]]);
    }
  }

  open(index, step) {
    const isOpen = this.player.open(index, step);
    if (isOpen) {
      this.isDrawn = false;
      // Only episodes of now have recordings.
      this.section.dataset.when = "now";
      const now = this.section.querySelector('.toggles [name="when"][value="now"]');
      if (now) now.checked = true;
      this.#legendOfEpisode(this.player.episode);
    }
    return isOpen;
  }

  /** Fills in the legend of trajectories; `states` are the states whose colours are drawn. */
  #legendOfTrajectories(all, states) {
    const ends = Object.keys(MARKS).map((end) => [end, all.trajectories.filter((drawn) => drawn.end === end).length]);
    this.#fillLegend([
      ...this.#states([...states].sort((a, b) => a - b)),
      ...ends.filter(([, count]) => count).map(([end, count]) => [`end ${end}`, "", `${count} ${MARKS[end].name}`]),
    ]);
  }

  #legendOfEpisode({ state, enemies, movers, entities, player }) {
    const small = player.crouching ? "; small: crouching" : "";
    const modes = [...new Set(enemies.flatMap((enemy) => enemy.mode))];
    this.#fillLegend([
      ...this.#states([...new Set(state)]),
      ["body player-body", this.maps.now.colours[state[0]], `the player, in the colour of the state${small}`],
      ...(entities.length ? [["body entity", "", "another thing"]] : []),
      ...modes.map((mode) => [`body enemy ${mode}`, "", `an enemy: ${mode}`]),
      ...(enemies.length ? [["cone", "", "what an enemy sees"]] : []),
      ...(enemies.some((enemy) => enemy.sees.includes(1)) ? [["cone sees", "", "… while it sees the player"]] : []),
      ...(movers.length ? [["mover", "", "a moving obstacle"]] : []),
    ]);
  }

  #states(states) {
    const { colours } = this.maps.now;
    return states.map((state) => ["trajectory", colours[state], [`state ${state}: `, ...label(this.facts, state)]]);
  }

  /** Each row has a class, a colour, and a text or its nodes.  Ends and bodies are drawn as marks, the rest as patches of colour. */
  #fillLegend(rows) {
    this.legend.replaceChildren(
      ...rows.map(([kind, colour, text]) => {
        const row = document.createElement("li");
        const sign = draw(row, "svg", { class: "plan", viewBox: "-8 -8 16 16", "aria-hidden": "true" });
        const end = kind.startsWith("end ") && MARKS[kind.slice(4)];
        const filled = colour && { fill: colour };
        if (end) draw(sign, "path", { class: kind, d: end.path });
        else if (kind.startsWith("body ")) draw(draw(sign, "g", { class: kind }), "circle", { r: 6, ...filled });
        else draw(sign, "rect", { class: `patch ${kind}`, x: -8, y: -5, width: 16, height: 10, ...filled });
        const words = document.createElement("span");
        words.append(...(typeof text === "string" ? prose(text) : text));
        row.append(words);
        return row;
      }),
    );
  }
}

class Report {
  constructor(data) {
    this.views = new Map(data.cases.map((facts) => [facts.slug, new CaseView(facts, data.colours, (player) => this.#moved(player))]));
    this.active = null;
    this.waiting = 0;
    this.filter = document.getElementById("page:only-findings");
    this.filter.addEventListener("change", () => this.#applyFilter());
    this.#applyFilter();
    // Draw a map when it comes near the screen: each case of a suite may have hundreds of trajectories.
    const near = new IntersectionObserver(
      (entries) => {
        for (const entry of entries) if (entry.isIntersecting) this.views.get(entry.target.id).drawOnce();
      },
      { rootMargin: "800px" },
    );
    for (const view of this.views.values()) near.observe(view.section);
    // A case of recorded traces has no map: its toggle switches the automaton alone.
    for (const form of document.querySelectorAll(".toggles.without-map")) {
      form.addEventListener("change", () => {
        form.closest(".case").dataset.when = new FormData(form).get("when") ?? "now";
      });
    }
    // Each case has the switch, next to its automaton; all switches are one.
    const switches = [...document.querySelectorAll('.toggles [name="notation"]')];
    for (const button of switches) {
      button.addEventListener("change", () => {
        document.documentElement.dataset.notation = button.value;
        for (const other of switches) other.checked = other.value === button.value;
      });
    }
    addEventListener("hashchange", () => this.#follow());
    // A click on a link does not change the address if it names this episode already.
    document.addEventListener("click", ({ target }) => {
      const link = target.closest("a");
      if (link?.hash && link.hash === location.hash) this.#follow();
    });
    addEventListener("beforeprint", () => {
      for (const view of this.views.values()) view.drawOnce();
    });
    document.addEventListener("keydown", (event) => this.#press(event));
    this.#follow();
  }

  /** Opens what the address names: `#case`, `#case/episode` or `#case/episode/step`. */
  #follow() {
    clearTimeout(this.waiting);
    const [slug, episode, step] = address();
    const section = document.getElementById(slug);
    if (!section?.classList.contains("case")) return;
    if (section.hidden) {
      this.filter.checked = false;
      this.#applyFilter();
    }
    const view = this.views.get(slug);
    // Remember the link now: a link on the map disappears when its episode is shown.
    const followed = document.activeElement?.closest("a");
    const isHere = section.querySelector(".stage")?.contains(document.activeElement);
    const isOpen = view && episode !== undefined && view.open(Number(episode), Math.round(Number(step)) || 0);
    if (isOpen) this.active = view;
    else if (view?.player.episode) view.showAll();
    // After a link, the keys control the player.
    if (isOpen && followed) view.player.scrub.focus({ preventScroll: true });
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (isOpen && followed?.matches(".links .episode") && !isStill) view.player.play();
    // A user who chose the episode on the map or in the list looks at it already.
    if (isHere) return;
    (isOpen ? section.querySelector(".automaton-title") : section).scrollIntoView();
  }

  /** Writes the current step into the address, but not at every frame. */
  #moved(player) {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => {
      if (!player.episode) return;
      history.replaceState(null, "", `#${player.facts.slug}/${player.episode.index}/${player.row}`);
    }, WAIT_MS);
  }

  #press(event) {
    const player = this.active?.player;
    if (!player?.episode || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.closest("button, select, summary, a, input:not(.scrub), .scroll")) return;
    if (!isOnScreen(this.active.section.querySelector(".stage"))) return;
    const actions = {
      " ": () => player.toggle(),
      ArrowLeft: () => player.seek(player.row - 1),
      ArrowRight: () => player.seek(player.row + 1),
      Home: () => player.seek(0),
      End: () => player.seek(player.last),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  #applyFilter() {
    for (const element of document.querySelectorAll("[data-verdict]")) {
      element.hidden = this.filter.checked && element.dataset.verdict === "pass" && !("newFailure" in element.dataset);
    }
  }
}

/** The parts of the page's address; a single empty one if the address is not valid. */
function address() {
  try {
    return decodeURIComponent(location.hash.slice(1)).split("/");
  } catch {
    return [""];
  }
}

function isOnScreen(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return bottom > 0 && top < innerHeight;
}

new Report(JSON.parse(document.getElementById("page:data").textContent));
