:- module(typhon_mobile,
          [ mobile_predicates/3,        % +Clauses, -Kinds, -Problems
            body_calls/2,               % +Body, -Calls
            is_mobile/2,                % +PI, +Mobile
            built_in/1,                 % +PI
            near_built_in/2,            % +PI, -Near
            vocabulary/1,               % +Module
            vocabulary_word/2           % ?Module, ?PI
          ]).
:- use_module(library(apply), [exclude/3, include/3, maplist/3]).
:- use_module(library(assoc),
              [ assoc_to_keys/2, empty_assoc/1, gen_assoc/3, get_assoc/3,
                list_to_assoc/2, put_assoc/4 ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, transpose_pairs/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module(bodies, [control/1]).
:- use_module(libraries, [declared_meta/3]).

/** <module> Which predicates of a program can reach a control predicate

A static predicate of an agent program is

  - `mobile` if it can reach a control predicate through its own
    clauses: the machine unfolds it;
  - `open` if it calls a goal that is known only at run time, or adds
    rules to the state: the machine unfolds it, too;
  - outside(PIs) if it calls predicates that are not in the program (state,
    payloads, the place): unfolded as long as one of them holds rules;
  - `native` otherwise: called at full speed.

on_message/2 is at least `open`, so that if it fails the machine can report
which of its goals failed.

A mobile goal under a construct that must run it to its end, such as findall/3,
forall/2 or \+, is a problem.

Modules declare by vocabulary/1 the other predicates that agents can call.

*Threading*: pure, except for a cache of facts about library predicates, and
declarations, which are made while modules are loaded.
*/

%!  mobile_predicates(+Clauses, -Kinds, -Problems) is det.
%
%   @arg Clauses are the static clauses as (Head:-Body)-Location
%   @arg Kinds is an ordered list of PI-Kind, one for each predicate
%   @arg Problems is a list of problem(Formal, Location, Advice)

mobile_predicates(Clauses, Kinds, Problems) :-
    maplist(clause_calls, Clauses, Located),
    findall(PI-own, member(calls(PI, _, _), Located), Pairs),
    table(Pairs, Own),
    findall(PI-Next,
            ( member(calls(PI, Calls, _), Located),
              member(Call, Calls),
              next_call(Call, Own, Next) ),
            Edges),
    kinds(Edges, Own, Kinds),
    findall(PI, member(PI-mobile, Kinds), Mobile),
    findall(Problem, misplaced(Located, Mobile, Problem), Problems1),
    findall(Problem, changed(Located, Own, Problem), Problems2),
    append(Problems1, Problems2, Problems).

clause_calls((Head:-Body)-Location, calls(Name/Arity, Calls, Location)) :-
    functor(Head, Name, Arity),
    body_calls(Body, Calls).

%   table(+Pairs, -Table): the values of each key.

table(Pairs0, Table) :-
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    list_to_assoc(Groups, Table).

is_own(PI, Own) :-
    get_assoc(PI, Own, _).

%   next_call(+Call, +Own, -Next) is semidet: the machine itself may come to
%   Next, a predicate or `unknown`.  A predicate that is called natively needs no
%   unfolding.

next_call(unknown(run), _, unknown).
next_call(call(PI, run), Own, PI) :-
    (   is_own(PI, Own)
    ;   is_control(PI)
    ;   \+ built_in(PI)
    ),
    !.

%   kinds(+Edges, +Own, -Kinds).  Each walk is from what is called to its callers:
%   one from each predicate would be quadratic, and peers send programs.

kinds(Edges, Own, Kinds) :-
    callers(Edges, Callers),
    callers_of(is_control, Callers, Mobile),
    callers_of(==(unknown), Callers, Open),
    exclude(is_known(Mobile, Open), Edges, Rest),
    callers(Rest, RestCallers),
    findall(PI-Outside,
            ( gen_assoc(Outside, RestCallers, _),
              \+ is_own(Outside, Own),
              reached([Outside], RestCallers, Set),
              gen_assoc(PI, Set, _) ),
            Pairs),
    table(Pairs, Outer),
    assoc_to_keys(Own, PIs),
    maplist(kind(Mobile, Open, Outer), PIs, Kinds).

callers(Edges, Callers) :-
    transpose_pairs(Edges, Reversed),
    table(Reversed, Callers).

:- meta_predicate callers_of(1, +, -).

callers_of(Goal, Callers, Set) :-
    assoc_to_keys(Callers, Called),
    include(Goal, Called, Targets),
    reached(Targets, Callers, Set).

is_known(Mobile, Open, PI-_) :-
    (   get_assoc(PI, Mobile, _)
    ->  true
    ;   get_assoc(PI, Open, _)
    ).

kind(Mobile, Open, Outer, PI, PI-Kind) :-
    (   get_assoc(PI, Mobile, _)
    ->  Kind = mobile
    ;   ( PI == on_message/2 ; get_assoc(PI, Open, _) )
    ->  Kind = open
    ;   get_assoc(PI, Outer, Outside)
    ->  Kind = outside(Outside)
    ;   Kind = native
    ).

%   reached(+From, +Table, -Reached): the keys of Reached are From and all to
%   which Table leads.

reached(From, Table, Reached) :-
    empty_assoc(Empty),
    reached(From, Table, Empty, Reached).

reached([], _, Reached, Reached).
reached([Key|Keys], Table, Reached0, Reached) :-
    (   get_assoc(Key, Reached0, _)
    ->  reached(Keys, Table, Reached0, Reached)
    ;   put_assoc(Key, Reached0, true, Reached1),
        (   get_assoc(Key, Table, More)
        ->  append(More, Keys, All)
        ;   All = Keys
        ),
        reached(All, Table, Reached1, Reached)
    ).

%!  is_mobile(+PI, +Mobile) is semidet.
%
%   PI is a control predicate, or one of Mobile.

is_mobile(PI, Mobile) :-
    (   is_control(PI)
    ->  true
    ;   memberchk(PI, Mobile)
    ).

is_control(Name/Arity) :-
    functor(Head, Name, Arity),
    control(Head).

misplaced(Located, Mobile,
          problem(permission_error(call, control_predicate, PI), Location,
                  inside(Context))) :-
    member(calls(_, Calls, Location), Located),
    member(call(PI, inside(Context)), Calls),
    is_mobile(PI, Mobile).

%   The program changes a predicate for which it has static clauses.  A clause
%   in the agent's module would only hide the predicate.

changed(Located, Own,
        problem(permission_error(modify, static_procedure, PI), Location,
                undeclared(PI))) :-
    member(calls(_, Calls, Location), Located),
    member(changes(PI), Calls),
    is_own(PI, Own).

                /*******************************
                *         WALK A BODY          *
                *******************************/

%!  body_calls(+Body, -Calls) is det.
%
%   Calls is an ordered set of call(PI, Mode) and unknown(Mode), where Mode
%   is `run` for goals that the machine may unfold and inside(PI) for
%   goals that the meta predicate PI runs to their end, and of changes(PI)
%   for assert and retract.

body_calls(Body, Calls) :-
    findall(Call, body_call(Body, run, Call), List),
    sort(List, Calls).

body_call(Var, Mode, unknown(Mode)) :-
    var(Var),
    !.
body_call(Goal, Mode, Call) :-
    part(Goal, Parts),
    !,
    member(Part, Parts),
    body_call(Part, Mode, Call).
body_call(_:_, _, _) :-
    !,
    fail.
body_call(Goal, Mode, Call) :-
    functor(Goal, call, Arity),
    Arity > 1,
    !,
    Goal =.. [_,Closure|Extra],
    extended(Closure, Extra, Mode, Call).
body_call(Goal, Mode, Call) :-
    callable(Goal),
    functor(Goal, Name, Arity),
    (   Call = call(Name/Arity, Mode)
    ;   adds_rules(Goal),
        Call = unknown(Mode)
    ;   changes(Goal, Call)
    ;   meta_argument(Goal, Name/Arity, Closure, Extra),
        extended(Closure, Extra, inside(Name/Arity), Call)
    ).

%   The goals that follow these may call rules that do not exist yet.

adds_rules(assert(Clause)) :- may_be_rule(Clause).
adds_rules(asserta(Clause)) :- may_be_rule(Clause).
adds_rules(assertz(Clause)) :- may_be_rule(Clause).
adds_rules(attach(_)).

may_be_rule(Clause) :- var(Clause), !.
may_be_rule((_:-_)).

changes(Goal, changes(Name/Arity)) :-
    compound(Goal),
    compound_name_arguments(Goal, Change, [Clause]),
    memberchk(Change, [assert,asserta,assertz,retract,retractall]),
    nonvar(Clause),
    ( Clause = (Head:-_) -> true ; Head = Clause ),
    callable(Head),
    Head \= _:_,
    functor(Head, Name, Arity).

%   The parts of constructs that the machine runs.

part((A,B), [A,B]).
part((A;B), [A,B]).
part((A->B), [A,B]).
part((A*->B), [A,B]).
part(call(A), [A]).
part(once(A), [A]).
part(ignore(A), [A]).
part(catch(A,_,B), [A,B]).
part(!, []).

extended(Closure, _, Mode, unknown(Mode)) :-
    var(Closure),
    !.
extended(_:_, _, _, _) :-
    !,
    fail.
extended(_^Goal, Extra, Mode, Call) :-
    !,
    extended(Goal, Extra, Mode, Call).
extended(_>>Lambda, _, Mode, Call) :-
    !,
    body_call(Lambda, Mode, Call).
extended(Closure, Extra, Mode, Call) :-
    callable(Closure),
    Closure =.. List0,
    append(List0, Extra, List),
    Goal =.. List,
    body_call(Goal, Mode, Call).

meta_argument(Goal, PI, Closure, Extra) :-
    meta(PI, Meta),
    arg(I, Meta, Spec),
    closure_arity(Spec, N),
    arg(I, Goal, Closure),
    length(Extra, N).

%   meta(+PI, -Meta) is semidet: cached, as it never changes, and is slow to
%   compute.

:- dynamic meta_known/2.

:- setting(known, positive_integer, 10 000,
           "Number of predicates whose meta arguments are remembered").

meta(PI, Meta) :-
    (   meta_known(PI, Meta0)
    ->  true
    ;   find_meta(PI, Meta0),
        bounded(meta_known(_, _), typhon_mobile:known,
                assertz(meta_known(PI, Meta0)))
    ),
    Meta0 \== none,
    Meta = Meta0.

find_meta(Name/Arity, Meta) :-
    functor(General, Name, Arity),
    (   declared_meta(typhon_vocabulary, General, Meta0)
    ->  Meta = Meta0
    ;   Meta = none
    ).

closure_arity(N, N) :- integer(N).
closure_arity(^, 0).
closure_arity(//, 2).

                /*******************************
                *          VOCABULARY          *
                *******************************/

:- dynamic vocabulary_module/1.         % Module

%!  vocabulary(+Module) is det.
%
%   A directive after `:- module(Module, Exports)`: agents can call Exports on
%   every host.

vocabulary(Module) :-
    (   vocabulary_module(Module)
    ->  true
    ;   assertz(vocabulary_module(Module))
    ),
    forall(vocabulary_word(Module, PI),
           typhon_vocabulary:import(Module:PI)).

%!  vocabulary_word(?Module, ?PI) is nondet.
%
%   Module defines PI for agents.

vocabulary_word(Module, PI) :-
    vocabulary_module(Module),
    module_property(Module, exports(PIs)),
    member(PI, PIs).

%!  built_in(+PI) is semidet.
%
%   PI belongs to the vocabulary of agents or to Prolog.

built_in(Name/Arity) :-
    functor(Head, Name, Arity),
    (   '$get_predicate_attribute'(typhon_vocabulary:Head, defined, 1)
    ->  true
    ;   predicate_property(system:Head, visible)
    ).

%!  near_built_in(+PI, -Near) is nondet.
%
%   Near is built in, and its name or arity is similar to that of PI.

near_built_in(Name/Arity, Near/NearArity) :-
    functor(Head, Name, Arity),
    dwim_predicate(typhon_vocabulary:Head, Module:NearHead),
    memberchk(Module, [typhon_vocabulary, system]),
    functor(NearHead, Near, NearArity),
    \+ sub_atom(Near, 0, _, _, $).
