// Buttons for recording, pausing and stepping, as far as the deployment offers them.
import {element} from './tables.js';

export class Controls {
  constructor(link, place) {
    this.link = link;
    this.place = place;
  }
  setInterfaces({tasks, control}) {
    this.control = control;
    this.loggers = tasks.filter((task) => task.properties.some((property) => property.name === 'record')).map((task) => task.name);
    this.replays = tasks.filter((task) => task.operations.includes('pause void(bool)')).map((task) => task.name);
    this.built_for = null;
  }
  button(text, ask, title) {
    return element('button', {title, onclick: async () => { this.said.textContent = (await ask()).refused ?? ''; }}, text);
  }
  build(status) {
    this.built_for = status.lockstep;
    this.said = element('span', {className: 'refused'});
    this.records = new Map(this.loggers.map((name) => [name, this.button(`● ${name}`, () => this.record(name), 'record, or pause recording')]));
    this.pause = this.button('pause', () => this.link.ask({pause: !this.paused}), 'simulated time stops');
    this.step = this.button('step', () => this.link.ask({step: true}), 'one more instant');
    const parts = [this.said, ...this.records.values(), ...(status.lockstep ? [this.pause, this.step] : [])];
    for (const name of status.lockstep ? [] : this.replays)
      parts.push(this.button(`pause ${name}`, () => this.link.call(`${name}.pause`, true), 'the log\'s time stops'),
                 this.button('go on', () => this.link.call(`${name}.pause`, false), 'the log\'s time continues'),
                 this.button('step', () => this.link.call(`${name}.step`), 'one instant of the log'));
    this.place.replaceChildren(...(this.control ? parts : []));
  }
  record(name) { return this.link.call(`${name}.setRecord`, !this.recording.get(name)); }
  update(status) {
    if (!this.loggers) return;
    if (this.built_for !== status.lockstep) this.build(status);
    this.paused = status.paused;
    this.pause.textContent = status.paused ? 'go on' : 'pause';
    this.step.disabled = !status.paused;
    this.recording = new Map(status.tasks.map((task) => [task.name, task.properties.record]));
    for (const [name, button] of this.records) button.className = this.recording.get(name) ? 'on' : '';
  }
}
