// node app/playground/build.js DIRECTORY: makes the playground there, a static
// site: the page, SWI-Prolog for WebAssembly, and a saved state in which the
// platform is loaded.  Servers compress it, so no file is compressed here.

'use strict';
const fs = require('fs'), path = require('path');
const vm = require('vm');
const { execFileSync } = require('child_process');
const { createHash } = require('crypto');
const { save, sources } = require('./state.js');

const root = path.join(__dirname, '../..');
const page = path.join(root, 'prolog/typhon/tools/page/www');
const NAMED = ['agents', 'payloads'];             // by programs
const READ = ['examples/studies',                 // by studies
  ...['allocation', 'hierarchy', 'learning', 'population', 'sieve', 'sync']
    .map(name => `experiments/${name}`)];

// Studies of the mechanisms, to set up with other parameters.
const STUDIES = ['examples/studies/coverage.pl', 'experiments/sync/study_demo.pl',
  'experiments/sieve/figure_3_3.pl', 'experiments/population/figure_6_3.pl',
  'experiments/allocation/figure_7_4.pl', 'experiments/learning/figure_4_7.pl',
  'experiments/hierarchy/beyond_lead.pl'];

const text = name => fs.readFileSync(path.join(root, name), 'utf8');

// Sessions of the documents, and studies of the mechanisms.
function programs() {
  const sessions = JSON.parse(execFileSync('swipl', ['-g', 'playables', '-t', 'halt',
    path.join(root, 'doc/site/playable.pl')], { encoding: 'utf8', maxBuffer: 1e8 }));
  const titled = sessions.map(({ id, ...rest }) =>
    ({ id, title: id.replace(/^doc\//, ''), ...rest }));
  return titled.concat(STUDIES.map(study => ({ id: study, title: study, queries: [],
    study: path.basename(study), folder: `/typhon/${path.dirname(study)}` })));
}

const files = folders => JSON.stringify(Object.fromEntries(folders.flatMap(sources)
  .map(name => [`/typhon/${name}`, text(name)])));

// SWI-Prolog without the bytes of its module, and these: so a browser compiles
// while it loads them.
function split(bundle) {
  const [, literal] = /binaryDecode\(('(?:[^'\\]|\\[^])*')\)/.exec(bundle);
  const coded = vm.runInNewContext(literal);
  const bytes = Buffer.alloc(coded.length);
  for (let i = 0; i < bytes.length; i++) {
    const code = coded.charCodeAt(i);
    bytes[i] = ~code >> 8 & code;
  }
  return [bundle.replace(literal, () => "''"), bytes];
}

async function build(to) {
  fs.mkdirSync(to, { recursive: true });
  const put = (name, content) => fs.writeFileSync(path.join(to, name), content);
  for (const name of fs.readdirSync(page))
    if (!/^(index|people)\b/.test(name)) put(name, fs.readFileSync(path.join(page, name)));
  for (const name of ['index.html', 'play.css', 'play.js', 'share.js', 'begin.js',
    'worker.js'])
    put(name, fs.readFileSync(path.join(__dirname, name)));
  put('programs.json', JSON.stringify(programs()));
  const [script, bytes] = split(text('test/lib/wasm/swipl-bundle-no-data.js'));
  put('swipl.js', script);
  put('swipl.wasm', bytes);
  put('typhon.state', await save());
  put('sources.json', files(NAMED));
  put('studies.json', files(READ));
  // The service worker keeps exactly these files, of this version.
  const names = fs.readdirSync(to).filter(name => name !== 'sw.js').sort();
  const hash = createHash('sha256');
  for (const name of names) hash.update(fs.readFileSync(path.join(to, name)));
  put('sw.js', text('app/playground/sw.js')
    .replace('"VERSION"', JSON.stringify(hash.digest('hex').slice(0, 16)))
    .replace('"FILES"', JSON.stringify(names)));
}

build(process.argv[2]).catch(error => {
  console.error(error.message);
  process.exitCode = 1;
});
