// Checks agent programs and payloads when they are opened and saved, and shows
// what agent_check/1 finds.

const vscode = require('vscode');
const {check, isProgram} = require('./check');

let shown;                      // diagnostics of all files
let complained = false;         // that Typhon is not found, once

function settings() {
    const own = vscode.workspace.getConfiguration('typhon');
    return {
        swipl: own.get('swipl'),
        library: own.get('library'),
        check: own.get('check')
    };
}

function diagnostic(problem) {
    const range = new vscode.Range(problem.line, problem.column,
        problem.line, Number.MAX_SAFE_INTEGER);
    const severity = problem.severity === 'error'
        ? vscode.DiagnosticSeverity.Error
        : vscode.DiagnosticSeverity.Warning;
    const made = new vscode.Diagnostic(range, problem.message, severity);
    made.source = 'Typhon';
    return made;
}

// Problems may be in files that the program includes.
function show(document, problems) {
    const byFile = new Map([[document.uri.fsPath, []]]);
    for (const problem of problems) {
        if (!byFile.has(problem.file)) {
            byFile.set(problem.file, []);
        }
        byFile.get(problem.file).push(diagnostic(problem));
    }
    for (const [file, diagnostics] of byFile) {
        shown.set(vscode.Uri.file(file), diagnostics);
    }
}

function checkDocument(document) {
    if (document.languageId !== 'prolog' || document.uri.scheme !== 'file') {
        return;
    }
    if (!isProgram(document.getText())) {
        shown.delete(document.uri);
        return;
    }
    const version = document.version;
    check(document.uri.fsPath, settings(), (error, problems) => {
        if (error && !complained) {
            complained = true;
            vscode.window.showWarningMessage(error.message);
        }
        if (!error && document.version === version) {
            show(document, problems);
        }
    });
}

function checkUnlessOff(document) {
    if (settings().check) {
        checkDocument(document);
    }
}

function activate(context) {
    shown = vscode.languages.createDiagnosticCollection('typhon');
    context.subscriptions.push(
        shown,
        vscode.workspace.onDidOpenTextDocument(checkUnlessOff),
        vscode.workspace.onDidSaveTextDocument(checkUnlessOff),
        vscode.workspace.onDidCloseTextDocument(
            document => shown.delete(document.uri)),
        vscode.commands.registerCommand('typhon.check', () => {
            const editor = vscode.window.activeTextEditor;
            if (editor) {
                complained = false;
                checkDocument(editor.document);
            }
        }));
    vscode.workspace.textDocuments.forEach(checkUnlessOff);
}

function deactivate() {}

module.exports = {activate, deactivate};
