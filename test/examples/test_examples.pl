:- module(test_examples, []).

% Every example runs by itself and prints what its newcomer wants to see.

:- use_module('../lib/common').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, member/2, select/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

%   shows(Example, Lines): patterns of lines in the output, in any order

shows(hello,
      [ 'Hello from alpha@127.0.0.1:*', 'Hello from beta@127.0.0.1:*',
        'hello.*@alpha@127.0.0.1:*: done'
      ]).
shows(tour,
      [ 'hop 1: north@*', 'hop 2: east@*', 'hop 3: south@*' ]).
shows(clone,
      [ 'scout.*@base@* is at north@*', 'scout.*@base@* is at east@*',
        'scout.*@base@* is at south@*'
      ]).
shows(payload,
      [ 'The courier knows: 100 C are 212* F', 'On beta 20 C are 68* F' ]).
shows(fipa,
      [ 'inform for 7 euro' ]).
shows(messages,
      [ '5, then 42' ]).
shows(stigmergy,
      [ 'An ant found food 1', 'An ant found food 2', 'An ant found food 3',
        'An ant found nothing', 'An ant found nothing', 'In the nest: ?*?'
      ]).
shows(rewrite,
      [ 'alpha is new to me', 'beta is new to me',
        'I know alpha', 'I know beta'
      ]).
shows(voting,
      [ 'agreed(12,3,of(4))' ]).
shows(pheromone,
      [ 'road@*: 67 % from farm@*', 'wood@*: 100 % from farm@*',
        'farm@*: the fire is out'
      ]).

example(Example) :-
    project_file('examples/*.pl', Pattern),
    expand_file_name(Pattern, Files),
    member(File, Files),
    file_base_name(File, Base),
    file_name_extension(Example, pl, Base).

run_example(Example, Lines) :-
    format(atom(Relative), 'examples/~w.pl', [Example]),
    project_file(Relative, File),
    run_swipl([File], [timeout(30)], Status, Out, Err),
    assertion(Status == exit(0)),
    assertion(Err == ""),
    split_string(Out, "\n", "", Lines0),
    append(Lines, [""], Lines0).

%   Each pattern matches a line of its own.

all_shown([], []).
all_shown([Pattern|Patterns], Lines) :-
    select(Line, Lines, Rest),
    wildcard_match(Pattern, Line),
    all_shown(Patterns, Rest).

file_lines(Example, Count) :-
    format(atom(Relative), 'examples/~w.pl', [Example]),
    project_file(Relative, File),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "", Lines),
    length(Lines, Count0),
    Count is Count0-1.

:- begin_tests(examples).

test(shows, [ forall(shows(Example, Patterns)), nondet ]) :-
    run_example(Example, Lines),
    assertion(all_shown(Patterns, Lines)).

test(tested, Examples == Tested) :-
    setof(Example, example(Example), Examples),
    setof(Example, Patterns^shows(Example, Patterns), Tested).

test(short, Long == []) :-
    findall(Example-Lines,
            ( example(Example),
              file_lines(Example, Lines),
              Lines >= 40
            ),
            Long).

:- end_tests(examples).
