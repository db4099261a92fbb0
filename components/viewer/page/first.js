// The properties used most: range, gain and frequency of the sonar that is shown.
import {upstream} from './places.js';
import {element, fieldOf, rank} from './tables.js';

const labels = {range: 'range', gain_db: 'gain', gain: 'gain', frequency_khz: 'frequency'};

export class First {
  constructor(link, place) {
    this.link = link;
    this.place = place;
    this.fields = [];
  }
  setInterfaces({tasks, control}) {
    this.tasks = tasks;
    this.control = control;
    this.key = null;
  }
  /** Finds for each label the first property of a task that contributes to the pings of `source`. */
  find(source, connections) {
    const made_by = upstream(connections, source), found = new Map();
    for (const task of this.tasks.filter((one) => made_by.has(one.name)))
      for (const property of task.properties)
        if (labels[property.name] && !found.has(labels[property.name])) found.set(labels[property.name], {task: task.name, property});
    return [...found].sort(([, a], [, b]) => rank(a.property) - rank(b.property));
  }
  update(status, source) {
    if (!this.tasks || !source) return;
    const found = this.find(source, status.connections), key = JSON.stringify(found);
    if (key !== this.key) this.build(found);
    this.key = key;
    for (const field of this.fields) field.update(status);
  }
  build(found) {
    this.fields = found.map(([, {task, property}]) => fieldOf(this.link, task, property, this.control));
    this.place.replaceChildren(...found.map(([label, {task, property}], i) =>
        element('label', {title: `${task}.${property.name}: ${property.doc}`}, label, this.fields[i].input, property.unit, ' ', this.fields[i].said)));
  }
}
