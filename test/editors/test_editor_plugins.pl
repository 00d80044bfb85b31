:- module(test_editor_plugins, []).

% The display of an agent program by the extension for VS Code and by the mode
% for Emacs.

:- use_module('../lib/common').
:- use_module('../../experiments/engine/studies', [study_load/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/json), [json_dict/2]).
:- use_module(library(typhon/kernel/program),
              [payload_load/2, program_load/6, vocabulary_word/2]).

program(Name, Path) :-
    absolute_file_name(path(Name), Path, [access(execute), file_errors(fail)]).

runs(Name, Arguments, Lines) :-
    program(Name, Program),
    setup_call_cleanup(
        process_create(Program, Arguments,
                       [ stdin(null), stdout(pipe(Out)), stderr(null),
                         process(Pid) ]),
        read_string(Out, _, Text),
        close(Out)),
    process_wait(Pid, Status),
    assertion(Status == exit(0)),
    split_string(Text, "\n", "\n", Lines0),
    subtract(Lines0, [""], Lines).

%   A program with an error in line 7 and a warning in line 8.

wrong("\c
:- agent(wrong, []).

% It can't do that.

main :-
    neighbours(Hosts),
    forall(member(Host, Hosts), move(Host)),
    nonsense(Hosts).
").

with_program(Text, Goal) :-
    with_tmp_dir(program_in(Text, Goal)).

%   The name of the file must be quoted.

program_in(Text, Goal, Dir) :-
    directory_file_path(Dir, 'it\'s.pl', File),
    setup_call_cleanup(open(File, write, Out), write(Out, Text), close(Out)),
    call(Goal, File).

library(File) :-
    project_file('prolog/typhon.pl', File).

vscode_shows(Problems, File) :-
    project_file('test/editors/vscode.js', Script),
    library(Library),
    current_prolog_flag(executable, Swipl),
    runs(node, [Script, Swipl, Library, File], Lines),
    maplist(json_dict, Lines, Dicts),
    findall(problem(Line, Severity, Message),
            ( member(Dict, Dicts),
              atom_string(Severity, Dict.severity),
              Line = Dict.line,
              Message = Dict.message ),
            Problems).

vscode_warns(Text, File) :-
    project_file('test/editors/vscode.js', Script),
    runs(node, [Script, '/nowhere/swipl', 'library(typhon)', File], [Line]),
    json_dict(Line, Dict),
    Text = Dict.warned.

emacs_shows(Lines, File) :-
    project_file('test/editors/emacs.el', Script),
    project_file('app/editors/emacs/typhon.el', Mode),
    library(Library),
    current_prolog_flag(executable, Swipl),
    runs(emacs, ['--batch', '-Q', '-l', Script, '--', Mode, Swipl, Library,
                 File], Lines).

                /*******************************
                *            WORDS             *
                *******************************/

%   The names of the vocabulary of agents.

word(Name) :-
    vocabulary_word(_, Name/_),
    \+ memberchk(Name, [enter, message_failed]).    % called by the platform

not_in(Relative, Missing) :-
    project_file(Relative, File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    findall(Name,
            ( word(Name),
              \+ ( member(Form, ["|~w|", "(?:~w|", "|~w)", "\"~w\""]),
                   format(string(Part), Form, [Name]),
                   sub_string(Text, _, _, _, Part) ) ),
            Missing0),
    sort(Missing0, Missing).

                /*******************************
                *           SNIPPETS           *
                *******************************/

snippet(Prefix, Text) :-
    project_file('test/editors/vscode.js', Script),
    runs(node, [Script, '--snippets'], Lines),
    member(Line, Lines),
    json_dict(Line, Dict),
    Prefix = Dict.prefix,
    Text = Dict.text.

%   Fragments are put into a program.

whole(Prefix, Text, Text) :-
    memberchk(Prefix, ["agent", "resident", "payload"]),
    !.
whole("tour", Text0, Text) :-
    !,
    format(string(Text), ":- agent(a, []).~nmain :- visit([]).~n~w~n", [Text0]).
whole(_, Text0, Text) :-
    format(string(Text),
           ":- agent(a, []).~nmain :- neighbours([Host|_]), here(_),~n~w.~n",
           [Text0]).

is_a_study(Text, Dir) :-
    directory_file_path(Dir, 'study.pl', File),
    setup_call_cleanup(open(File, write, Out), write(Out, Text), close(Out)),
    study_load(File, _).

all_in_order(Texts, Dir) :-
    findall(Text-Error,
            ( member(Text, Texts),
              program_in(Text, problem_of(Text, Error), Dir) ),
            Problems),
    assertion(Problems == []).

problem_of(Text, Error, File) :-
    catch(( loads(Text, File), fail ), error(Error, _), true).

loads(Text, File) :-
    (   sub_string(Text, 0, _, _, ":- payload(")
    ->  payload_load(File, _)
    ;   program_load(File, _, _, _, _, _)
    ).

json_file(Relative, Dict) :-
    project_file(Relative, File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    json_dict(Text, Dict).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(vscode).

test(problems_are_shown_at_their_lines, [condition(program(node, _))]) :-
    wrong(Text),
    with_program(Text, vscode_shows(Problems)),
    assertion(Problems = [problem(7, error, _), problem(8, warning, _)]),
    Problems = [problem(_, _, Message)|_],
    assertion(sub_string(Message, 0, _, _, "No permission")).
test(syntax_errors_are_shown, [condition(program(node, _)), nondet]) :-
    with_program(":- agent(a, []).\n\nmain :- foo(.\n",
                 vscode_shows(Problems)),
    assertion(Problems = [problem(3, error, _)|_]).
test(correct_program_has_no_problems,
     [condition(program(node, _)), true(Problems == [])]) :-
    with_program(":- agent(a, []).\nmain :- here(_).\n",
                 vscode_shows(Problems)).
test(other_files_are_not_checked,
     [condition(program(node, _)), true(Problems == [])]) :-
    with_program("main :- move(X), forall(a, move(b)).\n",
                 vscode_shows(Problems)).
test(missing_prolog_is_reported, [condition(program(node, _))]) :-
    wrong(Text),
    with_program(Text, vscode_warns(Warning)),
    assertion(sub_string(Warning, 0, _, _, "/nowhere/swipl does not run")).
test(grammar_contains_the_vocabulary, Missing == []) :-
    not_in('app/editors/vscode/syntaxes/prolog.tmLanguage.json', Missing).
test(task_and_extension_parse_problems_alike) :-
    json_file('app/editors/vscode/package.json', Package),
    [Matcher] = Package.contributes.problemMatchers,
    RegExp = Matcher.pattern.regexp,
    project_file('app/editors/vscode/check.js', File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    format(string(Literal), "/~w/;", [RegExp]),
    assertion(sub_string(Text, _, _, _, Literal)).
test(snippets_are_valid, [condition(program(node, _))]) :-
    findall(Prefix-Text, snippet(Prefix, Text), Snippets),
    assertion(Snippets = [_, _, _, _, _, _|_]),
    findall(Text,
            ( member(Prefix-Text0, Snippets),
              Prefix \== "study",           % below
              whole(Prefix, Text0, Text) ),
            Texts),
    with_tmp_dir(all_in_order(Texts)),
    memberchk("study"-Study, Snippets),
    with_tmp_dir(is_a_study(Study)).

:- end_tests(vscode).

:- begin_tests(emacs).

test(problems_are_shown_at_their_lines, [condition(program(emacs, _))]) :-
    wrong(Text),
    with_program(Text, emacs_shows(Lines)),
    assertion(Lines = [_, _, _]),
    append([First, Second], [Face], Lines),
    assertion(sub_string(First, 0, _, _, "7 :error No permission")),
    assertion(sub_string(Second, 0, _, _, "8 :warning ")),
    assertion(Face == "move is font-lock-keyword-face").
test(mode_contains_the_vocabulary, Missing == []) :-
    not_in('app/editors/emacs/typhon.el', Missing).

:- end_tests(emacs).
