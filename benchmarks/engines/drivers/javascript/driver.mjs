// Runs the generated and the handwritten monitor over the same traces, which have a line of numbers for each sample.
//
//     driver rows TRACE...               a row for each step, first of the generated, then of the handwritten one
//     driver time ROUNDS SECONDS TRACE   JSON lines: steps per second of CPU time in each round

import { readFileSync } from "node:fs";
import * as generated from "./@SPEC@_monitor.mjs";
import * as byHand from "@BY_HAND@/@SPEC@.mjs";

const MODULES = { generated, by_hand: byHand };

function samplesOf(path) {
  const lines = readFileSync(path, "ascii").trim().split("\n");
  return lines.map((line) => {
    const row = line.split(" ").map(Number);
    return { @ASSIGNMENTS@ };
  });
}

function pass(module, samples) {
  const monitor = new module.Monitor();
  const result = new module.Result();
  return (taken) => {
    let rewards = 0;
    monitor.reset();
    for (const sample of samples) {
      monitor.step(sample, result);
      rewards += result.reward;
      if (taken) taken(result);
    }
    return rewards;
  };
}

function rows(who, samples) {
  pass(MODULES[who], samples)((result) => {
    const { state, label, verdict, accepting, done, progress, reward, robustness, limiting } = result;
    const { label_english, failed_clause, failed_atom, failed_step } = result;
    const cells = [who, state, label, verdict, accepting, done, progress, reward, robustness, limiting];
    console.log([...cells, label_english, failed_clause, failed_atom, failed_step].join("\t"));
  });
}

function secondsOf(once, count) {
  const started = process.cpuUsage();
  let rewards = 0;
  for (let i = 0; i < count; i++) rewards += once();
  const { user, system } = process.cpuUsage(started);
  return [(user + system) / 1e6, rewards / count];
}

function time(rounds, enoughSeconds, samples) {
  const passes = Object.values(MODULES).map((module) => pass(module, samples));
  const repeats = passes.map((once) => {
    let count = 1;
    while (secondsOf(once, count)[0] < enoughSeconds) count *= 2;
    return count;
  });
  for (let round = 0; round < rounds; round++) {
    const measured = passes.map((once, who) => secondsOf(once, repeats[who]));
    const rates = measured.map(([seconds], who) => Math.round((samples.length * repeats[who]) / seconds));
    const rewards = measured.map(([, sum]) => sum);
    console.log(JSON.stringify({ generated: rates[0], by_hand: rates[1], rewards }));
  }
}

const [mode, ...words] = process.argv.slice(2);
if (mode === "rows") {
  for (const path of words) {
    const samples = samplesOf(path);
    for (const who of Object.keys(MODULES)) rows(who, samples);
  }
} else {
  time(Number(words[0]), Number(words[1]), samplesOf(words[2]));
}
