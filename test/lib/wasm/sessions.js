// node sessions.js SITE: plays each session that the playground in the folder SITE
// offers, as its worker does, and prints the names of those in which a query has no
// answer, or a file, predicate or service is missing.

'use strict';
const fs = require('fs');
const path = require('path');
const { boot, succeed } = require('../../../app/playground/state.js');
const site = process.argv[2];
const read = name => fs.readFileSync(path.join(site, name));
const text = value => (typeof value === 'object' ? value.v : value);
const MISSING = /does not exist|Unknown procedure|no_such_service/;
let said = [];

function ask(Module, message) {
  const { Out } = Module.prolog.query('typhon_page_tab:tab_ask(In, Out)',
    { In: JSON.stringify(message) }).once();
  return JSON.parse(text(Out));
}

// Go anew, as a reader does, when a session has stopped its network.
function run(Module) {
  for (let went = 0; went < 4; went++) {
    ask(Module, { do: 'go' });
    let more = 0;
    while (more >= 0)
      more = Number(text(Module.prolog.query(
        'typhon_page_tab:tab_slice(0.1, More)').once().More));
  }
}

function play(Module, { files, queries }) {
  said = [];
  const { error } = ask(Module, { do: 'play', files: Object.fromEntries(files),
    queries: queries.join('\n') });
  if (error) throw new Error(error);
  ask(Module, { do: 'speed', speed: null });
  run(Module);
}

const say = line => said.push(line);

boot(read('typhon.state'), say, say).then(Module => {
  for (const [name, content] of Object.entries(JSON.parse(read('sources.json')))) {
    Module.FS.mkdirTree(path.posix.dirname(name));
    Module.FS.writeFile(name, content);
  }
  succeed(Module, 'typhon_playground:playground_begin');
  for (const program of JSON.parse(read('programs.json')).filter(({ study }) => !study)) {
    play(Module, program);
    const answers = said.filter(line => /^(true|false)\.$/.test(line)).length;
    if (answers < program.queries.length || said.some(line => MISSING.test(line)))
      console.log(program.id, answers, program.queries.length,
        said.filter(line => MISSING.test(line)).join('; '));
  }
}).catch(error => {
  console.error(error.message);
  process.exitCode = 1;
});
