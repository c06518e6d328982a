// mozzi as WebAssembly: robots from text, and every quantity by its name. The other side is crates/mozzi-web/src/abi.rs.

import { unzipped } from "./data.js";
import { Robot } from "./robot.js";

export class Library {
  static async open(base64) {
    const { instance } = await WebAssembly.instantiate(await unzipped(base64), {});
    return new Library(instance.exports);
  }

  constructor(exports) {
    this.exports = exports;
  }

  // A robot of a file's text: URDF, xacro, MJCF, or JSON by the file's name.
  load(fileName, text) {
    const named = new TextEncoder().encode(fileName).length;
    const number = this.call("web_load", [named], fileName + text);
    return new Robot(this, number, JSON.parse(this.said()));
  }

  // Calls a function that reads `text`; throws its error.
  call(name, values, text = "") {
    const bytes = new TextEncoder().encode(text);
    const answer = this.trap(() => {
      const address = this.exports.web_text(bytes.length); // before the buffer: the memory may grow
      new Uint8Array(this.exports.memory.buffer, address, bytes.length).set(bytes);
      return this.exports[name](...values);
    });
    if (answer === -1) throw new Error(this.said());
    return answer;
  }

  // The address of an array, which is never 0.
  address(name, values, text) {
    const address = this.call(name, values, text);
    if (address === 0) throw new Error(this.said());
    return address;
  }

  trap(call) {
    try {
      return call();
    } catch (error) {
      const { web_panic, web_panic_length } = this.exports;
      throw new Error(this.text(web_panic(), web_panic_length()) || error.message);
    }
  }

  said() {
    return this.text(this.exports.web_said(), this.exports.web_said_length());
  }

  text(address, length) {
    return new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, address, length));
  }

  // Made anew for each use: when the memory grows, older views are detached.
  floats(address, length) {
    return new Float64Array(this.exports.memory.buffer, address, length);
  }
}
