:- module(test_terminal, []).

% Output of agents while a query is typed.

:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3, file_lines/2]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

:- needs([python3]).

%   screen(+Steps, +Program, -Rows): the screen after Steps at a top level that
%   has loaded Program.

screen(Steps, Program, Rows) :-
    with_tmp_dir(screen(Steps, Program, Rows)).

screen(Steps, Program, Rows, Dir) :-
    directory_file_path(Dir, 'program.pl', File),
    project_file('prolog/typhon.pl', Typhon),
    write_file(File, ':- use_module(~q).~n~s', [Typhon, Program]),
    project_file('test/lib/screen.py', Screen),
    current_prolog_flag(executable, Swipl),
    append([[Screen], Steps, [--, Swipl, '-f', none, '-g',
             'set_prolog_flag(toplevel_prompt, \'?- \')', File]], Args),
    python(Python),
    directory_file_path(Dir, out, OutFile),
    setup_call_cleanup(
        open(OutFile, write, OutStream),
        ( process_create(Python, Args,
                         [ stdin(null), stdout(stream(OutStream)),
                           cwd(Dir), process(Pid) ]),
          process_wait(Pid, Status) ),
        close(OutStream)),
    file_lines(OutFile, Rows0),
    exclude(==(""), Rows0, Rows),
    assertion(Status-Rows = exit(0)-_).

:- begin_tests(terminal).

%   Lines of agents and messages are shown whole, and typed input is read
%   unchanged.

test(agents_print_while_a_query_is_typed) :-
    screen(['at:?- ', 'type:go.\\n', 'see:true.', 'at:?- ',
            'type:format(ab', 'see:xxxxx',
            'type:c).', 'type:\\n', 'at:?- '],
           "go :-
    host_start(alpha),
    agent_create(clauses([(:- agent(chat, [])),
                          (main :- sleep(1.5),
                                   format('two~nlines~n'),
                                   log(told),
                                   format('~`xt~70|~n'))]), _).
", Rows),
    append(_, [Two, "lines"|Below], Rows),
    !,
    assertion(sub_string(Two, _, _, 0, "two")),
    assertion(( member(Log, Below),
                wildcard_match("% chat.*at alpha: told", Log) )),
    assertion(( member(X70, Below), string_length(X70, 70) )),
    assertion(memberchk("abc", Below)).

:- end_tests(terminal).

