// node run.js PROLOG FILE: consults FILE, and calls main/0, in SWI-Prolog for
// WebAssembly, where the sources of the folder PROLOG are library(typhon).

const fs = require('fs');
const path = require('path');
const SWIPL = require('./swipl-bundle.js');
const [prolog, file] = process.argv.slice(2);

function copy(Module, from, to) {
  Module.FS.mkdir(to);
  for (const name of fs.readdirSync(from)) {
    const source = path.join(from, name);
    const target = `${to}/${name}`;
    if (fs.statSync(source).isDirectory()) {
      copy(Module, source, target);
    } else if (name.endsWith('.pl')) {
      Module.FS.writeFile(target, fs.readFileSync(source));
    }
  }
}

SWIPL({ arguments: ['-q'], print: console.log, printErr: console.error })
  .then((Module) => {
    copy(Module, prolog, '/prolog');
    Module.FS.writeFile('/main.pl', fs.readFileSync(file));
    const goal = "asserta(user:file_search_path(library, '/prolog'))," +
      "consult('/main.pl'), main";
    const answer = Module.prolog.query(goal).once();
    process.exitCode = answer.success === true ? 0 : 1;
  });
