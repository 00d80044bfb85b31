:- module(test_user_program, []).
:- use_module('../../app/packaging/parts', [installed/1]).
:- use_module('../lib/common').

% A program of a user, and the flags that it sets, do not change the library.

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, list_to_set/2, member/2]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_permutation/2]).

%   lives(+Lines, -Trouble) is det.
%
%   A file of Lines is loaded first, then the library is used as always.
%   Trouble is [] if nothing was other than without Lines.

lives(Lines, Trouble) :-
    with_tmp_dir(lives(Lines, Trouble)).

lives(Lines, Trouble, Dir) :-
    directory_file_path(Dir, 'program.pl', File),
    setup_call_cleanup(
        open(File, write, Out),
        forall(member(Line, Lines), format(Out, "~w~n", [Line])),
        close(Out)),
    project_file('test/lib/ordinary_life.pl', Life),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    run_swipl(['-q', '-p', Path, '-f', File, Life], [timeout(120)], Status,
              Said, Warned),
    findall(Line, ( member(Line, [Status, Said, Warned]), \+ usual(Line) ),
            Trouble).

usual(exit(0)).
usual("").
usual("life(\"a string\",42,[agents,hosts,time])\n\c
       [created,ended(done),[1.5,'An atom']]\n").

usual(Warning) :-                       % of Prolog itself
    string(Warning),
    aggregate_all(count, sub_string(Warning, _, _, _,
                                    "Using a non-error value for unknown"),
                  Times),
    Times > 0,
    Lines is 5*Times,
    aggregate_all(count, sub_string(Warning, _, _, _, "\n"), Lines).

%   defines(-PI): of system, or of an autoloaded library, if users may define it.

defines(Name/Arity) :-
    current_predicate(Name, system:Head),
    functor(Head, Name, Arity),
    \+ sub_atom(Name, 0, _, _, $).
defines(Name/Arity) :-
    '$in_library'(Name, Arity, _).

may_define(Name/Arity) :-
    functor(Head, Name, Arity),
    setup_call_cleanup(
        set_module(test_user_names:class(temporary)),
        catch(assertz(test_user_names:Head),
              error(permission_error(_, _, _), _), fail),
        '$destroy_module'(test_user_names)).

%   fact(+Always, +PI, -Line): Line defines PI, with a fact that is always
%   true, or with one that is true of what the library never passes.

fact(Always, Name/Arity, Line) :-
    functor(Head, Name, Arity),
    (   Always == true
    ->  true
    ;   Head =.. [_|Args],
        maplist(=('of the user'), Args)
    ),
    format(string(Line), "~q.", [Head]).

facts(PIs, Facts) :-
    findall(Fact, ( member(PI, PIs), random_fact(PI, Fact) ), Facts).

random_fact(PI, Fact) :-
    Always is random(2),
    (   Always =:= 1
    ->  fact(true, PI, Fact)
    ;   fact(false, PI, Fact)
    ).

%   culprits(+Lines, -Culprits): the program of Lines, after the import of the
%   library, does not live as without them.  One of them is enough.

culprits(Lines, Culprits) :-
    lives([":- use_module(library(typhon))."|Lines], Trouble),
    (   ( Trouble == [] ; Lines = [_] )
    ->  findall(Lines-Trouble, Trouble \== [], Culprits)
    ;   halves(Lines, Half),
        culprits(Half, Culprits),
        Culprits \== []
    ->  true
    ;   Culprits = [Lines-Trouble]
    ).

halves(Lines, Half) :-
    length(Lines, N),
    Count is N//2,
    length(Some, Count),
    append(Some, Rest, Lines),
    member(Half, [Some, Rest]).

:- begin_tests(user_program).

test(any_predicate_may_be_defined, Culprits == []) :-
    set_random(seed(1)),
    findall(PI, ( defines(PI), may_define(PI) ), All0),
    sort(All0, All),
    random_permutation(All, Permuted),
    length(Drawn, 300),
    append(Drawn, _, Permuted),
    list_to_set([get_time/1, string_concat/3, split_string/4|Drawn], PIs),
    facts(PIs, Lines),
    culprits(Lines, Culprits).

%   sets(Group, Set): what one program sets. Values of one flag are in different
%   groups.

sets(1, (:- set_prolog_flag(Flag, Value))) :-
    member(Flag=Value,
           [ autoload=false, protect_static_code=true, double_quotes=codes,
             generate_debug_info=false, occurs_check=true,
             character_escapes=false, rational_syntax=natural,
             prefer_rationals=true, last_call_optimisation=false ]).
sets(2, (:- set_prolog_flag(Flag, Value))) :-
    member(Flag=Value,
           [ double_quotes=atom, stream_type_check=true, occurs_check=error,
             unknown=fail, optimise=true, back_quotes=symbol_char,
             float_undefined=nan, debug=true ]).
sets(2, (:- op(0, xfx, =), op(0, xfy, :), op(0, yfx, -), op(200, xfy, log))).
sets(3, (:- set_prolog_flag(Flag, Value))) :-
    member(Flag=Value,
           [ iso=true, double_quotes=string, unknown=warning, var_prefix=true ]).
sets(3, (:- dynamic(goal_expansion/2))).
sets(3, (goal_expansion(member(_, _), fail))).
sets(3, (term_expansion((_ :- _), []))).

%   What the group First sets holds when the library is loaded, what the other
%   sets when it loads its parts.

test(any_flag_may_be_set,
     [ forall(member(First-Then, [1-3, 3-2, 2-1])), Trouble == [] ]) :-
    findall(Line, line(First, Line), Before),
    findall(Line, line(Then, Line), After),
    append(Before, [":- use_module(library(typhon))."|After], Lines),
    lives(Lines, Trouble).

line(Group, Line) :-
    sets(Group, Set),
    format(string(Line), "~k.", [Set]).

test(unsupported_options_are_named, [ forall(member(Option, [ '--traditional',
                                                 '--no-threads' ])),
                                      Lines == 2 ]) :-
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    run_swipl([Option, '-p', Path, '-g', 'use_module(library(typhon))', '-t',
               halt], [], exit(0), "", Said),
    once(sub_string(Said, _, _, _, Option)),
    aggregate_all(count, sub_string(Said, _, _, _, "\n"), Lines).

%   In either order, and by swipl -g "use_module(library(tartarus))" File.

test(own_names_come_first, Trouble == []) :-
    own_names(Facts),
    findall(Use, uses(Use), Uses),
    append(Uses, Facts, After),
    append(Facts, Uses, Before),
    lives(After, Trouble0),
    lives(Before, Trouble1),
    append(Trouble0, Trouble1, Trouble).

uses(":- use_module(library(tartarus)).") :-
    installed(tartarus).
uses(":- use_module(library(typhon)).").

own_names(["home(1).", "now(1).", "log(1).", "parent(1).", "move(1)."]).

test(typhon_and_tartarus_in_one_program,
     [ condition(installed(tartarus)),
       forall(member(Uses, [[typhon, tartarus], [tartarus, typhon]])) ]) :-
    with_tmp_dir(both(Uses)).

both(Uses, Dir) :-
    directory_file_path(Dir, 'both.pl', File),
    directory_file_path(Dir, saved, Saved),
    free_port(Port),
    setup_call_cleanup(
        open(File, write, Out),
        both(Out, Uses, Port, Saved),
        close(Out)),
    project_file(prolog, Library),
    atom_concat('library=', Library, Path),
    run_swipl(['-q', '-p', Path, '-g', both, '-t', halt, File], [], exit(0),
              Printed, ""),
    once(sub_string(Printed, _, _, _, "[mover]done\ndone\n")).

both(Out, Uses, Port, Saved) :-
    forall(member(Use, Uses),
           format(Out, ":- use_module(library(~w)).~n", [Use])),
    format(Out, ":- dynamic walks/3.~n\c
                 walks(guid, _, main) :- true.~n\c
                 both :- start_tartarus(localhost, ~w, 1),~n\c
                 agent_create(mover, (localhost,~w), walks),~n\c
                 list_agents(L), findall(N, member((N,_,_), L), Ns),~n\c
                 agent_save(mover, '~w'), write(Ns),~n\c
                 host_start(alpha),~n\c
                 agent_create(clauses([(:- agent(x, [])), main]), A, [host(alpha)]),~n\c
                 agent_join(A, O1, 10), writeln(O1),~n\c
                 agent_create(clauses([(:- agent(x, [])), main]), B, [host(alpha)]),~n\c
                 agent_join(B, O2, 10), writeln(O2),~n\c
                 close_tartarus, host_stop(alpha).~n", [Port, Port, Saved]).

:- end_tests(user_program).
