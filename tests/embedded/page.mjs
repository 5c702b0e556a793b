// Runs the WebAssembly module that is its argument, and prints what it prints.
import { readFileSync } from "node:fs";

let text = "";
const host = {
  print: (at, bytes) => (text += new TextDecoder().decode(new Uint8Array(instance.exports.memory.buffer, at, bytes))),
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
process.exitCode = instance.exports.run();
process.stdout.write(text);
