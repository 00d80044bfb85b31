:- module(test_compiling, []).

/** <module> The library is loaded as it was written

Clauses of most files are stored as they are read.  Each test loads the library
in a process of its own.

*Threading*: one test at a time.
*/

:- use_module('../../../lib/common', [project_file/2, run_swipl/5]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(lists), [append/2, member/2, subtract/3]).

%   printed(+Goals, -Term): what a process prints that calls Goals, texts.

printed(Goals, Term) :-
    findall(Arg, ( member(Goal, Goals), member(Arg, ['-g', Goal]) ), Args0),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    append([['-q', '-f', none, '-p', Path], Args0, ['-t', halt]], Args),
    run_swipl(Args, [timeout(120)], exit(0), Out, ""),
    term_string(Term, Out).

%   Before is called before the library is loaded.

clauses_of_files(Before, Hashes) :-
    project_file('test/lib/clauses_of_files.pl', File),
    format(atom(Print), 'use_module(~q),clauses_of_files', [File]),
    printed([Before,Print], Hashes).

:- begin_tests(compiling).

test(clauses_are_those_that_expansion_would_give, Others == []) :-
    clauses_of_files(true, Stored),
    clauses_of_files('use_module(library(typhon/kernel/base/on_demand),[]),\c
                      retract((system:term_expansion(_, []) :- \c
                               _:typhon_compiling:stored(_)))', Expanded),
    length(Stored, Count),
    assertion(Count > 150),
    subtract(Stored, Expanded, Others).

test(clauses_exist_once_when_their_file_is_loaded_again, N-M == N-N) :-
    printed([ 'use_module(library(typhon))',
              'assertz((clauses(N) :- \c
                   predicate_property(typhon_machine:step(_,_,_,_,_), \c
                                      number_of_clauses(N))))',
              'clauses(N),assertz(before(N))',
              'load_files(library(typhon/kernel/program/machine), \c
                          [if(true),silent(true)])',
              'before(N),clauses(M),print(N-M)' ],
            N-M).
test(cross_reference_reads_clauses_and_stores_none, N-M == N-N) :-
    printed([ 'use_module(library(typhon)),use_module(library(prolog_xref))',
              'assertz((clauses(N) :- \c
                   predicate_property(typhon_fifo:fifo_size(_,_), \c
                                      number_of_clauses(N))))',
              'module_property(typhon_fifo, file(File)),clauses(N),\c
               xref_source(File, [silent(true)]),\c
               xref_defined(File, fifo_size(_,_), local(_)),\c
               clauses(M),print(N-M)' ],
            N-M).

test(topics_of_the_kernel_are_declared, Missing == []) :-
    findall(Topic, topic_in('prolog/typhon/kernel', Topic), Topics0),
    sort(Topics0, Topics),
    assertion(Topics = [_,_|_]),
    format(atom(Print),
           'findall(T, ( member(T, ~q), \\+ debugging(typhon(T), _) ), Ts), \c
            print(Ts)', [Topics]),
    printed(['use_module(library(typhon))',Print], Missing).

topic_in(Folder, Topic) :-
    project_file(Folder, Dir),
    directory_member(Dir, File, [extensions([pl]), recursive(true)]),
    read_file_to_string(File, Text, []),
    sub_string(Text, B, L, _, "debug(typhon("),
    Begin is B+L,
    sub_string(Text, Begin, _, 0, Rest),
    once(sub_string(Rest, End, _, _, ")")),
    sub_atom(Rest, 0, End, _, Topic),
    Topic \== 'Name'.             % in typhon_compiling

:- end_tests(compiling).
