// The playground: programs in an editor beside the views of the page, and the
// queries, or the study, that run them. The address has the program after #:
//
//     #doc=ID     a session of the documents, or a study
//     #p=TEXT     what Share has packed
//
// Nothing runs before a click on Set up: then a worker begins, see begin.js.

import { button, element } from './dom.js';
import { dialog, field } from './forms.js';
import { Share } from './share.js';
import { editor } from './work.js';

const PATIENCE = 20000;         // ms without an answer: the worker is ended
const LINES = 500;
const EXAMPLE = 'doc/classics.md:1';

const { app } = globalThis.typhon;
const { connection, store } = app;

class Playground {
  constructor(parent) {
    this.begun = false;
    this.files = new Map();
    this.name = null;           // of the file in the editor
    this.editor = editor({ draft: '', ask: message => this.check(message) });
    this.which = element('select', { 'aria-label': 'Example',
      onchange: () => { location.hash = `doc=${this.which.value}`; } });
    this.tabs = element('div', { class: 'play-bar', role: 'group', 'aria-label': 'Files' });
    this.queries = element('textarea', { class: 'play-queries', 'aria-label': 'Queries',
      spellcheck: 'false', autocomplete: 'off', wrap: 'off' });
    this.study = element('p', { class: 'muted', hidden: true });
    this.said = element('pre', { class: 'play-said', role: 'log', tabindex: 0,
      'aria-label': 'Output' });
    this.stop = button('Stop', () => this.end('It was stopped'), { disabled: true });
    parent.append(element('div', { class: 'play-bar' },
      button('Set up', () => this.setUp(), { class: 'primary' }), this.stop,
      button('Share', () => this.share()), this.which),
    this.tabs, this.editor.element, this.queries, this.study, this.said);
    connection.onNews = ({ said = [], ended }) => {
      said.forEach(line => this.say(line));
      if (ended) this.end(ended);
    };
    addEventListener('hashchange', () => this.load());
    setInterval(() => this.watch(), 1000);
  }

  // -------------------------------------------------------------- program

  async begin() {
    const found = await fetch('programs.json').then(got => got.json());
    this.programs = new Map(found.map(program => [program.id, program]));
    this.which.append(...found.map(({ id, title }) =>
      element('option', { value: id }, title)));
    await this.load();
  }

  async load() {
    const [, kind, text] = /^#(doc|p)=(.*)$/.exec(location.hash) ?? [];
    try {
      const id = kind === 'doc' ? decodeURIComponent(text) : EXAMPLE;
      const program = kind === 'p' ? await Share.unpack(text) : this.programs.get(id);
      if (!program) throw new Error(`There is no program ${id}`);
      if (program.study) await this.loadStudies();
      this.which.value = kind === 'p' ? '' : id;
      this.show({ files: this.filesOf(program), ...program });
    } catch (error) {
      app.note(`The link cannot be read: ${error.message}`, 'error');
    }
  }

  async loadStudies() {
    this.studies ??= await fetch('studies.json').then(got => got.json());
  }

  // The files of a study are those of its folder.
  filesOf({ folder }) {
    return Object.entries(this.studies ?? {})
      .filter(([name]) => name.replace(/\/[^/]*$/, '') === folder)
      .map(([name, text]) => [name.replace(/.*\//, ''), text]);
  }

  show({ files, queries, study, folder }) {
    this.folder = folder;
    this.files = new Map(files);
    this.queries.value = queries.join('\n');
    this.queries.hidden = Boolean(study);
    this.file = study ?? null;
    this.study.hidden = !study;
    this.study.textContent = study
      ? `The study ${study}: Set up opens its model, with sliders and plots.` : '';
    this.open(study ?? [...this.files.keys()].at(-1));
  }

  keep() {
    if (this.name !== null) this.files.set(this.name, this.editor.value);
  }

  open(name) {
    if (this.name !== name) this.name = null;
    this.name = name ?? null;
    this.editor.element.hidden = this.name === null;
    if (this.name !== null) this.editor.value = this.files.get(name);
    this.tabs.replaceChildren(...[...this.files.keys()].map(other =>
      button(other, () => { this.keep(); this.open(other); },
        { 'aria-pressed': String(other === name) })),
    button('New file …', () => this.newFile()));
  }

  newFile() {
    const name = field('Name', { required: true, pattern: '[a-z][A-Za-z0-9_]*\\.pl',
      value: 'agent.pl' });
    dialog('New file', [name], 'Create', async () => {
      this.keep();
      this.files.set(name.input.value, ':- agent(agent, []).\n\nmain :-\n    true.\n');
      this.open(name.input.value);
    });
  }

  get program() {
    this.keep();
    return { files: [...this.files], study: this.file, folder: this.folder,
             queries: this.queries.value.split('\n').filter(line => line.trim()) };
  }

  async share() {
    location.hash = `p=${await Share.pack(this.program)}`;
    const copied = await navigator.clipboard?.writeText(location.href)
      .then(() => true, () => false);
    app.note(copied ? 'The link is copied' : 'The address of this page has the program');
  }

  // The marks of the editor, for agent programs; others are no agents.
  async check(message) {
    if (!this.begun || !/^:- agent\(/m.test(message.text)) return { said: [] };
    return app.ask(message);
  }

  // ------------------------------------------------------------------ run

  async setUp() {
    this.said.textContent = '';
    this.stop.disabled = false;
    globalThis.playground.begin();
    const { files, queries, study, folder } = this.program;
    try {
      // A study is loaded once.
      if (this.loaded) await connection.stop('Set up anew');
      this.loaded = study;
      this.begun = true;
      const overlays = [...store.overlays.values()];
      if (study) await connection.post({ do: 'save', files: this.studies });
      await app.ask({ do: 'play', files: Object.fromEntries(files),
        ...(study ? { study, folder } : { queries: queries.join('\n') }) });
      store.reset();
      for (const overlay of overlays) store.overlay(overlay);
      await connection.post({ do: 'first' });
      await app.run.again();
      this.editor.check();
    } catch (error) {
      app.note(error.message, 'error');
    }
  }

  say(line) {
    const lines = `${this.said.textContent}${line}\n`.split('\n');
    this.said.textContent = lines.slice(-LINES).join('\n');
    this.said.scrollTop = this.said.scrollHeight;
  }

  // A goal that does not end keeps the worker from answering.
  watch() {
    if (this.begun && performance.now() - connection.waitsSince > PATIENCE)
      this.end('It ran on without an answer, so it was stopped');
  }

  end(why) {
    connection.stop(why);
    this.say(`% ${why}. Set up starts it anew.`);
  }
}

const made = globalThis.playground.page =
  new Playground(document.getElementById('play'));
made.begin().catch(error => app.note(error.message, 'error'));
if (navigator.serviceWorker && location.protocol !== 'file:')
  navigator.serviceWorker.register('sw.js').catch(() => { /* works without it */ });
