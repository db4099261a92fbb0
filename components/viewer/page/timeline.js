// The position in each log that is played, and seeking in it.
import {element} from './tables.js';

const text = ({at_s, length_s}) => `${at_s.toFixed(1)} / ${length_s.toFixed(1)} s`;

export class Timelines {
  constructor(link, place) {
    this.link = link;
    this.place = place;
    this.rows = new Map();
  }
  setInterfaces({tasks, control}) {
    this.seekers = new Set(control ? tasks.filter((task) => task.operations.includes('seek void(double)')).map((task) => task.name) : []);
    this.rows.clear();
    this.place.replaceChildren();
  }
  row(name) {
    const slider = element('input', {type: 'range', min: 0, step: 0.01, disabled: !this.seekers?.has(name), title: `${name}: seconds after the first stamp of the log`});
    const told = element('span', {className: 'figure'}), said = element('span', {className: 'refused'});
    slider.onpointerdown = () => { slider.held = true; };
    slider.onpointerup = slider.onpointercancel = () => { slider.held = false; };
    slider.onchange = async () => {
      said.textContent = (await this.link.call(`${name}.seek`, slider.value)).refused ?? '';
    };
    this.rows.set(name, {slider, told});
    this.place.append(element('div', {className: 'timeline'}, element('i', {className: 'dim'}, name), slider, told, said));
    return this.rows.get(name);
  }
  update(status) {
    for (const {name, playback} of status.tasks) {
      if (!playback) continue;
      const {slider, told} = this.rows.get(name) ?? this.row(name);
      slider.max = playback.length_s;
      if (!slider.held) slider.value = playback.at_s;
      told.textContent = text(playback);
    }
  }
}
