:- module(typhon_problem_text, []).
:- use_module(library(apply), [maplist/3]).
:- use_module('../kernel/base/error_text', [error_lines/3]).
:- use_module('../kernel/base/names', [names_joined/3]).
:- autoload('../language', [problem_error/3]).

/** <module> Texts of problems of programs, with advice

A problem, see typhon_programs, is raised and printed as

    error(Formal, at(Location, Text, Others))

where Text proposes a fix, and Others are problems found with it.

*Threading*: pure.
*/

:- multifile
    prolog:error_message//1,
    prolog:message_context//1,
    prolog:message_location//1,
    typhon_programs:advice//1.

                /*******************************
                *             TEXTS            *
                *******************************/

prolog:error_message(singletons(Names)) -->
    { atomic_list_concat(Names, ', ', Text) },
    [ 'Variables that occur once: ~w'-[Text] ].
prolog:error_message(discontiguous(PI)) -->
    [ 'Clauses of ~p are not together'-[PI] ].
prolog:error_message(undeclared_state(PI)) -->
    [ '~p is changed, and not declared as state'-[PI] ].
prolog:error_message(unknown_procedure(PI)) -->
    [ 'Unknown procedure: ~p'-[PI] ].
prolog:error_message(lost_choice(Choice, Control, Test)) -->
    [ '~p gives up '-[Control] ],
    given_up(Choice),
    [ ': ~p does not come back to them'-[Test] ].

given_up(clause) --> !,
    [ 'the clauses below' ].
given_up(Choice) -->
    [ 'the choices of ~p'-[Choice] ].

%   The location is printed in the form that editors recognise.

prolog:message_location(at(Location, _, _)) -->
    place(Location).

prolog:message_context(at(_, Advice, Others)) -->
    advised(Advice),
    others(Others).

place(File:Line) -->
    [ '~w:~d: '-[File, Line] ].
place(clause(0)) --> !,
    [ 'there are no clauses: ' ].
place(clause(N)) -->
    [ 'clause ~d: '-[N] ].
place(file(File, Line, LinePos, _)) -->
    [ '~w:~d:~d: '-[File, Line, LinePos] ].

advised('') -->
    !.
advised(Advice) -->
    [ ' (~w)'-[Advice] ].

others([]) -->
    [].
others([Problem|Others]) -->
    { problem_error(Problem, [], Error) },
    [ nl ],
    error_lines(Error),
    others(Others).

                /*******************************
                *            ADVICE            *
                *******************************/

typhon_programs:advice(none) -->
    [].
typhon_programs:advice(singletons) -->
    ['if it is meant to occur once, write it with an underscore first'].
typhon_programs:advice(discontiguous(Name/Arity)) -->
    { term_to_atom(Name/Arity, Atom) },
    ['put them together, or write :- discontiguous ', Atom, '.'].
typhon_programs:advice(include([])) -->
    ['cannot include'].
typhon_programs:advice(include([File|Files])) -->
    { names_joined([File|Files], ' or ', Meant) },
    ['cannot include: did you mean ', Meant, '?'].
typhon_programs:advice(include_itself) -->
    ['a file cannot include itself'].
typhon_programs:advice(grammar) -->
    ['not a grammar rule'].
typhon_programs:advice(declare(agent)) -->
    ['begin the file with :- agent(Name, [state([Name/Arity, ...])]).'].
typhon_programs:advice(declare(payload)) -->
    ['begin the file with :- payload(Name, [provides([Name/Arity, ...])]).'].
typhon_programs:advice(directive) -->
    ['nothing runs at load time; allowed are agent/1,2, payload/1,2, \c
      dynamic/1, discontiguous/1, include/1, op/3, encoding(utf8) and \c
      use_module(library(_))'].
typhon_programs:advice(once) -->
    ['a file begins with one declaration: move what follows it to a file \c
      of its own'].
typhon_programs:advice(library) -->
    ['no such library: install it, or write library(Name) or \c
      library(Folder/Name), not a path'].
typhon_programs:advice(indicator) -->
    ['write dynamic Name/Arity, ...'].
typhon_programs:advice(rule) -->
    ['write Head :- Body'].
typhon_programs:advice(head) -->
    ['a clause head is an atom or a compound term'].
typhon_programs:advice(body) -->
    ['a clause body is built of callable terms'].
typhon_programs:advice(qualified) -->
    ['an agent has no modules: write the head without one'].
typhon_programs:advice(redefined) -->
    ['the name is taken: rename the predicate'].
typhon_programs:advice(entry([])) -->
    ['define main/0, on_message/2 or both'].
typhon_programs:advice(entry([Written-Meant|_])) -->
    { maplist(term_to_atom, [Meant, Written], [A, B]) },
    ['define main/0, on_message/2 or both; did you mean ', A, ' by ', B, '?'].
typhon_programs:advice(options(agent)) -->
    ['write agent(Name, [state([Name/Arity, ...])])'].
typhon_programs:advice(options(payload)) -->
    ['write payload(Name, [provides([Name/Arity, ...])])'].
typhon_programs:advice(undeclared(Name/Arity)) -->
    { term_to_atom(Name/Arity, Atom) },
    ['predicates that an agent changes are its state: \c
      write agent(Name, [state([',
     Atom, '])])'].
typhon_programs:advice(offered([])) -->
    ['a place or a payload must offer it'].
typhon_programs:advice(offered([PI|PIs])) -->
    { names_joined([PI|PIs], ' or ', Meant) },
    ['did you mean ', Meant, '? If not, a place or a payload must offer it'].
typhon_programs:advice(of_library(Library)) -->
    ['library(', Library, ') defines it: write :- use_module(library(',
     Library, ')) in the program'].
typhon_programs:advice(commits(Choice)) -->
    ['a stop discards choice points: '],
    instead(Choice).
typhon_programs:advice(inside(Name/Arity)) -->
    { term_to_atom(Name/Arity, Atom) },
    ['an agent cannot stop inside ', Atom, ': '],
    outside(Name/Arity).

%   instead(+Choice)//: the advice for a choice that a stop discards.

instead(clause) --> !,
    ['write ( Goal -> ... ; ... ), which travels, instead of two clauses'].
instead((;)/2) --> !,
    ['write ( Goal -> ... ; ... ), which travels'].
instead(_) -->
    ['collect them with findall/3, and go through the list by recursion'].

%   outside(+PI)//: the advice for a stop inside a goal that must run to its
%   end.

outside(PI) --> { repeats(PI) }, !,
    ['write a recursive predicate instead'].
outside((\+)/1) --> !,
    ['write ( Goal -> fail ; true ) instead'].
outside(PI) --> { cleans_up(PI) }, !,
    ['open resources cannot travel: let the goal end before the agent \c
      stops, and catch errors with catch/3'].
outside(call_with_time_limit/_) --> !,
    ['receive/2 has a time limit'].
outside(_) -->
    ['stop before it, or after it'].

repeats(Name/_) :-
    memberchk(Name,
              [ findall, findnsols, bagof, setof, aggregate_all, aggregate,
                forall, foreach, maplist, foldl, include, exclude, partition,
                foldr, call_nth, limit, offset, order_by,
                distinct, convlist, phrase ]).

cleans_up(Name/_) :-
    memberchk(Name,
              [ setup_call_cleanup, call_cleanup, with_output_to, with_mutex,
                with_tty_raw, transaction, snapshot, sig_atomic ]).
