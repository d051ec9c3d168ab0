// A trained agent for the page. It needs `npm install` in this folder, and `tltlc inspect courier.safetensors -o courier.onnx`.

const RUNTIME = "./node_modules/onnxruntime-web/dist/ort.wasm.bundle.min.mjs";

/** Return a function that chooses an action by the observation, and by the state and the progress of the monitor. */
export async function loadAgent() {
  const { InferenceSession, Tensor, env } = await import(RUNTIME);
  env.wasm.numThreads = 1;
  const session = await InferenceSession.create("courier.onnx");
  const states = session.inputMetadata.find((input) => input.name === "automaton").shape[1];
  const row = (numbers) => new Tensor("float32", Float32Array.from(numbers), [1, numbers.length]);
  return async (observation, state, progress) => {
    const automaton = Array.from({ length: states }, (_, index) => (index === state ? 1 : 0));
    const inputs = { observation: row(observation), automaton: row(automaton), progress: row([progress]) };
    return Number((await session.run(inputs)).action.data[0]);
  };
}
