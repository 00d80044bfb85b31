:- module(test_child_output, []).

% Output and messages of the child processes of a network are printed by the
% process that started it.

:- use_module('../../lib/common').
:- use_module(library(apply), [exclude/3, maplist/2, maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(plunit)).

%   said(+Options, -Out, -Err): the output of a program whose network of two
%   processes has an agent that prints much. Options are those of swipl.

said(Options, Out, Err) :-
    with_tmp_dir(said(Options, Out, Err)).

said(Options, Out, Err, Dir) :-
    directory_file_path(Dir, 'program.pl', File),
    project_file('prolog/typhon.pl', Typhon),
    setup_call_cleanup(
        open(File, write, Stream),
        ( program(Program),
          format(Stream, ':- use_module(~q).~n~s', [Typhon, Program]) ),
        close(Stream)),
    append(Options, ['-f', none, '-g', 'go,halt', File], Args),
    run_swipl(Args, [], Status, OutText, ErrText),
    assertion(Status-ErrText = exit(0)-_),
    lines(OutText, Out),
    lines(ErrText, Err).

program("go :-
    network_start(ring(2), N, [processes(2)]),
    network_property(N, hosts([_,H])),
    agent_create(clauses([(:- agent(chat, [])),
        (main :- format('two~nlines\\e[2J~n'), write(a), write(b), nl,
                 write(begun), log(told), send(user, hi),
                 print_message(warning, format('mind~nthis', [])),
                 dispose)]),
        A, [host(H)]),
    agent_join(A, disposed, 20),
    network_stop(N).
").

lines(Text, Lines) :-
    split_string(Text, "\n", "", Lines0),
    exclude(==(""), Lines0, Lines).

:- begin_tests(child_output).

unmarked(Line, Text) :-
    once(sub_string(Line, Before, 2, _, "] ")),
    Start is Before+2,
    sub_string(Line, Start, _, 0, Text).

test(output_logs_and_warnings) :-
    said([], Out, Err),
    assertion(maplist(wildcard_match("[[]network[0-9]*/2] *"), Out)),
    maplist(unmarked, Out, Texts),
    assertion(Texts == ["two", "lines\\x1B\\[2J", "ab", "begun"]),
    assertion(Err = [_, _, _, _]),
    Err = [Log, Told, Mind, This],
    assertion(wildcard_match("% chat.*@n2@* at n2: told", Log)),
    assertion(wildcard_match("% chat.*@n2@* says hi", Told)),
    assertion(wildcard_match("Warning: ?network*/2? mind", Mind)),
    assertion(wildcard_match("Warning: ?network*/2? this", This)).

test(child_is_as_quiet_as_its_parent) :-
    said(['-q'], Out, Err),
    assertion(length(Out, 4)),
    assertion(length(Err, 2)).

:- end_tests(child_output).
