// What made a bin, as the sonar that sent the ping explains it.
import {upstream} from './places.js';

const poll_ms = 100;

export class Explanation {
  constructor(link, place) {
    this.link = link;
    this.place = place;
    this.asked = 0;
  }
  setInterfaces({tasks}) {
    this.sonars = new Set(tasks.filter((task) => task.operations.some((one) => one.startsWith('explain text('))).map((task) => task.name));
  }
  /** Explains the bin at a place [rad, m] of the newest ping of `source`; a later call takes the place of this one. */
  async ask(source, connections, {bearing, range}) {
    const asked = ++this.asked, sonar = [...upstream(connections, source)].find((task) => this.sonars?.has(task));
    this.place.textContent = sonar ? 'explaining ...' : 'no sonar of this deployment explains this ping';
    const degrees = (bearing * 180 / Math.PI).toFixed(3);
    while (sonar && asked === this.asked) {
      const {result, refused} = await this.link.call(`${sonar}.explain`, degrees, range.toFixed(4));
      if (asked !== this.asked) return;
      if (result || refused) return void (this.place.textContent = result || refused);
      await new Promise((done) => setTimeout(done, poll_ms));
    }
  }
  clear() {
    ++this.asked;
    this.place.textContent = '';
  }
}
