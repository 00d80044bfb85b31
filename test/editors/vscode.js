// Runs the extension with a stand-in for VS Code, and prints what it shows:
//
//   node vscode.js SWIPL LIBRARY FILE
//
// and, for each snippet, its name and its text when every default is
// accepted:
//
//   node vscode.js --snippets

const fs = require('fs');
const Module = require('module');
const path = require('path');

const folder = path.join(__dirname, '../../app/editors/vscode');

// "${1:name}" and "$0"; "${2/\/.*//}" is placeholder 2 without what follows
// a slash.
function expanded(body) {
    const text = body.join('\n');
    const values = new Map();
    for (const match of text.matchAll(/\$\{(\d+):([^}]*)\}/g)) {
        values.set(match[1], match[2]);
    }
    return text
        .replace(/\$\{(\d+)\/\\\/\.\*\/\/\}/g,
            (_, n) => values.get(n).replace(/\/.*/, ''))
        .replace(/\$\{\d+:([^}]*)\}/g, '$1')
        .replace(/\$\d+/g, '');
}

function snippets() {
    const file = path.join(folder, 'snippets/agents.json');
    const all = JSON.parse(fs.readFileSync(file));
    for (const {prefix, body} of Object.values(all)) {
        console.log(JSON.stringify({prefix, text: expanded(body)}));
    }
}

class Diagnostic {
    constructor(range, message, severity) {
        Object.assign(this, {range, message, severity});
    }
}

class Range {
    constructor(line, column) {
        Object.assign(this, {line, column});
    }
}

function standIn(swipl, library, document, shown, warn) {
    const none = {dispose() {}};
    return {
        Diagnostic,
        Range,
        DiagnosticSeverity: {Error: 'error', Warning: 'warning'},
        Uri: {file: fsPath => ({fsPath, scheme: 'file'})},
        commands: {registerCommand: () => none},
        languages: {createDiagnosticCollection: () => shown},
        window: {showWarningMessage: warn},
        workspace: {
            textDocuments: [document],
            getConfiguration: () => ({
                get: name => ({swipl, library, check: true})[name]
            }),
            onDidOpenTextDocument: () => none,
            onDidSaveTextDocument: () => none,
            onDidCloseTextDocument: () => none
        }
    };
}

function opened(swipl, library, file) {
    const document = {
        languageId: 'prolog',
        uri: {fsPath: file, scheme: 'file'},
        version: 1,
        getText: () => fs.readFileSync(file, 'utf8')
    };
    const shown = {
        dispose() {},
        delete() {},
        set(uri, diagnostics) {
            for (const {range, message, severity} of diagnostics) {
                console.log(JSON.stringify({
                    file: path.basename(uri.fsPath), line: range.line + 1,
                    severity, message
                }));
            }
        }
    };
    const warn = text => console.log(JSON.stringify({warned: text}));
    const vscode = standIn(swipl, library, document, shown, warn);
    const load = Module._load;
    Module._load = (name, ...rest) =>
        name === 'vscode' ? vscode : load(name, ...rest);
    require(path.join(folder, 'extension.js')).activate({subscriptions: []});
}

if (process.argv[2] === '--snippets') {
    snippets();
} else {
    opened(...process.argv.slice(2));
}
