:- module(typhon_programs,
          [ program_read/5,             % +Spec, -Program, -Initial, -Kinds,
                                        % -Sources
            payload_load/2,             % +Spec, -Payload
            program_hash/2,             % +Program, -Hash
            agent_check/1               % +Spec
          ]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2, nth1/3, selectchk/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../base/afresh', [raising_afresh/1]).
:- use_module(mobile, [body_calls/2, mobile_predicates/3]).
:- use_module(problems,
              [ advice_text/2, clause_problem/2, directive_problem/2,
                entry_problem/3, option_problem/2 ]).
:- use_module(source,
              [ clause_parts/3, declaration/4, library_import/2,
                source_terms/2, source_terms/3 ]).

/** <module> Agent programs and payloads

An agent program is a clause file that begins with `:- agent(Name, Opts)`,
a payload one that begins with `:- payload(Name, Opts)`.  What is read
becomes a plain term:

  - program(Name, State, Libraries, Clauses): the immutable part.  State
    are the predicate indicators of what is mutable, Libraries what
    use_module/1,2 named, Clauses the static clauses as Head:-Body.
  - payload(Name, Predicates, Clauses)

A problem is problem(Formal, Location, Advice): an ISO error, where it
stands and what to do about it.

*Threading*: any thread; nothing is stored here.
*/

%!  program_read(+Spec, -Program, -Initial, -Kinds, -Sources) is det.
%
%   Read an agent program.
%
%   @arg Initial are the clauses of its state predicates: the state of an
%        agent at birth.
%   @arg Kinds is what mobile_predicates/3 finds.
%   @arg Sources is what it was read from, see source_terms/3.
%   @error The first problem of the program, as an ISO error whose context
%        is context(Location, Advice).

program_read(Spec, Program, Initial, Kinds, Sources) :-
    source_terms(Spec, Located, Sources),
    program(Located, Program, Initial, Kinds, Problems),
    no_problems(Problems).

%!  payload_load(+Spec, -Payload) is det.
%
%   Read a payload file, or payload(Name, Predicates, Clauses) itself.

payload_load(payload(Name, PIs, Clauses), Payload) :-
    !,
    must_be(atom, Name),
    Payload = payload(Name, PIs, Clauses).
payload_load(Spec, payload(Name, PIs, Clauses)) :-
    source_terms(Spec, Located),
    declared(payload, Located, Name, Options, Rest, Problems0),
    partition(is_directive, Rest, Directives, Clauses0),
    findall(P, directive_problem(Directives, P), Problems1),
    findall(P, clause_problem(Clauses0, P), Problems2),
    append([Problems0, Problems1, Problems2], Problems),
    no_problems(Problems),
    ( memberchk(provides(Provided), Options) -> true ; Provided = [] ),
    maplist(located_clause, Clauses0, Clauses),
    findall(PI, clause_indicator(Clauses, PI), Defined),
    append(Provided, Defined, PIs0),
    sort(PIs0, PIs).

no_problems([]).
no_problems([problem(Formal, Location, Advice)|_]) :-
    advice_text(Advice, Text),
    throw(error(Formal, context(Location, Text))).

%   program(+Located, -Program, -Initial, -Kinds, -Problems): the problems in
%   the order of the file.

program(Located, program(Name, State, Libraries, Static), Initial, Kinds,
        Problems) :-
    declared(agent, Located, Name, Options, Rest, Problems0),
    partition(is_directive, Rest, Directives, Clauses0),
    maplist(located_rule, Clauses0, Clauses1),
    findall(PI, state_indicator(Options, Directives, PI), State0),
    sort(State0, State),
    findall(Library, library_directive(Directives, Library), Libraries),
    partition(in_state(State), Clauses1, Initial0, Static0),
    findall(P, directive_problem(Directives, P), Problems1),
    findall(P, clause_problem(Clauses0, P), Problems2),
    findall(P, entry_problem(Located, Clauses1, P), Problems3),
    findall(P, option_problem(Located, P), Problems4),
    append([Problems0, Problems1, Problems2, Problems3, Problems4],
           Problems5),
    moves(Problems5, Static0, Kinds, Problems6),
    in_file_order(Problems6, Located, Problems),
    maplist(located_clause, Static0, Static),
    maplist(located_clause, Initial0, Initial).

%   A program whose clauses are faulty is not looked at any further.

moves([], Static, Kinds, Problems) :-
    !,
    mobile_predicates(Static, Kinds, Problems).
moves(Problems, _, [], Problems).

%   in_file_order(+Problems0, +Located, -Problems)

in_file_order(Problems0, Located, Problems) :-
    maplist(position(Located), Problems0, Keyed0),
    keysort(Keyed0, Keyed),
    pairs_values(Keyed, Problems).

position(Located, Problem, N-Problem) :-
    Problem = problem(_, Location, _),
    (   nth1(N0, Located, _-Location)
    ->  N = N0
    ;   N = 0
    ).

                /*******************************
                *           THE PARTS          *
                *******************************/

declared(Kind, Located, Name, Options, Rest, []) :-
    member(Term-_, Located),
    declaration(Kind, Term, Name, Options),
    !,
    selectchk(Term-_, Located, Rest).
declared(Kind, Located, unknown, [], Located,
         [problem(existence_error(declaration, Kind), Location,
                  declare(Kind))]) :-
    (   member((:- Directive)-Location0, Located),
        compound(Directive),
        compound_name_arity(Directive, Kind, _)
    ->  Location = Location0            % meant to be one
    ;   Located = [_-Location0|_]
    ->  Location = Location0
    ;   Location = clause(0)
    ).

is_directive(Term-_) :-
    nonvar(Term),
    Term = (:- _).

located_rule(Term-Location, (Head:-Body)-Location) :-
    clause_parts(Term, Head, Body).

located_clause(Term-_, Clause) :-
    (   clause_parts(Term, Head, Body),
        Body \== true
    ->  Clause = (Head:-Body)
    ;   clause_parts(Term, Clause, _)
    ).

clause_indicator(Clauses, Name/Arity) :-
    member(Clause, Clauses),
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity).

in_state(State, (Head:-_)-_) :-
    callable(Head),
    functor(Head, Name, Arity),
    memberchk(Name/Arity, State).

state_indicator(Options, _, PI) :-
    member(state(PIs), Options),
    indicator_in(PIs, PI).
state_indicator(_, Directives, PI) :-
    member((:- dynamic(PIs))-_, Directives),
    indicator_in(PIs, PI).

indicator_in(Var, _) :- var(Var), !, fail.
indicator_in([H|T], PI) :- !, member(X, [H|T]), indicator_in(X, PI).
indicator_in((A,B), PI) :- !, ( indicator_in(A, PI) ; indicator_in(B, PI) ).
indicator_in(Name/Arity, Name/Arity) :- atom(Name), integer(Arity).

library_directive(Directives, Library) :-
    member((:- Directive)-_, Directives),
    library_import(Directive, Library).

                /*******************************
                *             HASH             *
                *******************************/

%!  program_hash(+Program, -Hash:atom) is det.
%
%   The name of Program: SHA-256 of its canonical text, the same on every
%   Prolog version and word size.

program_hash(Program, Hash) :-
    Program = program(_, State, Libraries, Clauses),
    with_output_to(string(Text),
                   forall(member(Term, [State,Libraries|Clauses]),
                          print_canonical(Term))),
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(utf8)]),
    hash_atom(Bytes, Hash).

print_canonical(Term) :-
    \+ \+ ( numbervars(Term, 0, _, [functor_name('$typhon_variable')]),
            write_term(Term, [ quoted(true), ignore_ops(true) ]),
            nl
          ).

                /*******************************
                *            CHECK             *
                *******************************/

%!  agent_check(+Spec) is det.
%
%   Print what is wrong with an agent program: what would keep it from
%   loading, and calls to predicates that neither the program nor the
%   vocabulary defines, so that a place or a payload must offer them.

agent_check(Spec) :-
    raising_afresh(source_terms(Spec, Located)),
    program(Located, _, _, _, Problems),
    findall(Warning, undefined(Located, Warning), Warnings0),
    sort(Warnings0, Warnings),
    forall(member(P, Problems), report(error, P)),
    forall(member(P, Warnings), report(warning, P)),
    length(Problems, Errors),
    length(Warnings, Undefined),
    print_message(informational, typhon(checked(Spec, Errors, Undefined))).

report(Severity, problem(Formal, Location, Advice)) :-
    advice_text(Advice, Text),
    print_message(Severity, error(Formal, context(Location, Text))).

undefined(Located,
          problem(existence_error(procedure, PI), Location, offered)) :-
    declared(agent, Located, _, Options, Rest, _),
    partition(is_directive, Rest, Directives, Clauses0),
    maplist(located_rule, Clauses0, Clauses),
    findall(P, state_indicator(Options, Directives, P), State),
    member((_:-Body)-Location, Clauses),
    body_calls(Body, Calls),
    member(call(PI, _), Calls),
    \+ memberchk(PI, State),
    \+ defined(PI, Clauses, Directives).

defined(Name/Arity, Clauses, Directives) :-
    functor(Head, Name, Arity),
    (   member((Head:-_)-_, Clauses)
    ;   predicate_property(system:Head, visible)
    ;   predicate_property(typhon_vocabulary:Head, defined)
    ;   library_directive(Directives, Library-_),
        offers(Library, Name/Arity)
    ),
    !.

offers(Library, PI) :-
    absolute_file_name(Library, File,
                       [ file_type(prolog), access(read),
                         file_errors(fail) ]),
    module_property(Module, file(File)),
    module_property(Module, exports(Exports)),
    memberchk(PI, Exports).
