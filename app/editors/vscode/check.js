// What agent_check/1 says of a file, as problems with a place. Knows nothing of
// VS Code, so that it can be tested without it.

const {execFile} = require('child_process');
const path = require('path');

// "ERROR: /home/me/a.pl:7: No permission ..." or, of syntax errors, with a
// column: "ERROR: /home/me/a.pl:7:4: Syntax error: ..."
const PROBLEM =
    /^(ERROR|Warning): +(?:\[[^\]]*\] +)?(.+?):(\d+):(?:(\d+):)? +(.*)$/;
const PROGRAM = /^[ \t]*:-[ \t\r\n]*(agent|payload)\(/m;

// Lines and columns count from 0.
function problems(text) {
    const found = [];
    for (const line of text.split(/\r?\n/)) {
        const match = PROBLEM.exec(line);
        if (match) {
            found.push({
                severity: match[1] === 'ERROR' ? 'error' : 'warning',
                file: match[2],
                line: Math.max(0, Number(match[3]) - 1),
                column: match[4] === undefined ? 0 : Number(match[4]),
                message: match[5]
            });
        }
    }
    return found;
}

function isProgram(text) {
    return PROGRAM.test(text);
}

// An atom as Prolog reads it.
function quoted(text) {
    return `'${text.replace(/\\/g, '\\\\').replace(/'/g, "\\'")}'`;
}

function goals(file, library) {
    const source = /^library\(\w+\)$/.test(library) ? library : quoted(library);
    return ['-q', '-g', `use_module(${source})`,
        '-g', `agent_check(${quoted(file)})`, '-t', 'halt'];
}

// done(error, problems): error if SWI-Prolog or Typhon is not there.
function check(file, settings, done) {
    const options = {cwd: path.dirname(file), timeout: 30000};
    execFile(settings.swipl, goals(file, settings.library), options,
        (error, stdout, stderr) => {
            if (error && (error.code === 'ENOENT' || error.killed)) {
                done(new Error(`${settings.swipl} does not run: ` +
                               `${error.message}`), []);
            } else if (/agent_check\/1|source_sink/.test(stderr) &&
                       /Unknown procedure|does not exist/.test(stderr)) {
                done(new Error(`Typhon is not found as ${settings.library}: ` +
                               'set typhon.library'), []);
            } else {
                done(null, problems(stderr));
            }
        });
}

module.exports = {check, goals, isProgram, problems};
