:- module(typhon_checks,
          [ agent_check/1,              % +Spec
            agent_check/2               % +Spec, +Options
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module('../kernel/base/options', [check_options/2]).
:- use_module('../kernel/program', [mobile_predicates/3]).
:- autoload('../language',
            [ declaration/4, file_parts/4, in_file_order/3,
              library_directive/2, part/3, payload_terms/3, program_terms/6,
              source_terms/5 ]).
:- autoload('checks/lost_choices', [lost_choice/3]).
:- autoload('checks/warnings',
            [ apart_problem/3, print_problem/2, program_warnings/3,
              unknown_problems/2 ]).

/** <module> Checks of programs and payloads

This is the interface of the layer.  Its modules are loaded when a program is
checked or read from a file for the first time.

*Threading*: any thread.
*/

:- multifile objection/3.               % Options, Program, Where-Formal
:- dynamic objection/3.

%!  agent_check(+Spec) is det.
%
%   Print errors and warnings of an agent program, or of a payload.  A program
%   with errors does not load.  Warnings are about
%
%     - variables that occur once, and clauses of a predicate with others in
%       between
%     - predicates that the program changes, and does not declare as its state
%     - choice points that a stop discards, and on which the program seems to
%       rely
%     - for an agent, calls of predicates that neither the program nor the
%       vocabulary defines, so that a place or a payload must offer them
%
%   If a part cannot be read, only syntax errors are reported.  agent_create/3
%   raises the errors, and prints the warnings once for each program, until its
%   file changes.  It omits a warning of the last kind if a payload of the
%   agent, or the place of a host of this process, defines the predicate.

agent_check(Spec) :-
    once(source_terms(Spec, Located, _, Unread, Once)),
    problems_of(Unread, Located, Errors, Likely, Undefined),
    append([Once, Likely, Undefined], Warnings0),
    in_file_order(Warnings0, Located, Warnings),
    forall(member(P, Errors), print_problem(error, P)),
    forall(member(P, Warnings), print_problem(warning, P)),
    maplist(length, [Errors, Warnings, Undefined], [E, W0, U]),
    W is W0-U,
    print_message(informational, typhon(checked(Spec, E, W, U))).

%!  agent_check(+Spec, +Options:list) is semidet.
%
%   Options describe the host on which the program or the payload will run.
%   With the option policy(Policy), see host_start/2, code that a host with that
%   policy would refuse is reported as errors, and agent_check/2 fails if there
%   are any.

agent_check(Spec, Options) :-
    check_options(check_option, Options),
    agent_check(Spec),
    once(source_terms(Spec, Located, _, Unread, _)),
    (   Unread == []
    ->  no_objections(Options, Spec, Located)
    ;   Options == []
    ).

%   objection(+Options, +Program, -Objection) is nondet: hook.  A host with
%   Options would refuse program(Rules, Libraries) for Objection, Where-Formal.
%   Rules are pairs Rule-Location; Where is unbound if the location is not known.

no_objections(Options, Spec, Located) :-
    ( is_payload(Located) -> Kind = payload ; Kind = agent ),
    file_parts(Kind, Located, Parts, _),
    part(rules, Parts, Rules),
    findall(Library, library_directive(Parts, Library-_), Libraries),
    findall(Objection,
            objection(Options, program(Rules, Libraries), Objection),
            Objections),
    forall(member(Where-Formal, Objections),
           ( ignore(Where = Spec),
             print_message(error, typhon(not_let_in(Where, Formal))) )),
    Objections == [].

%   problems_of(+Unread, +Located, -Errors, -Warnings, -Undefined): with syntax
%   errors Unread there are no other problems, since parts of the program are
%   missing.

problems_of([Error|Errors], _, [Error|Errors], [], []).
problems_of([], Located, Errors, Warnings, Undefined) :-
    (   is_payload(Located)
    ->  payload_problems(Located, Errors, Warnings),
        Undefined = []
    ;   program_terms(Located, _, _, Kinds, _, Errors),
        program_warnings(Located, Kinds, Warnings),
        unknown_problems(Located, Undefined)
    ).

is_payload(Located) :-
    member(Term-_, Located),
    declaration(payload, Term, _, _),
    !,
    \+ ( member(Agent-_, Located), declaration(agent, Agent, _, _) ).

payload_problems(Located, Errors, Warnings) :-
    payload_terms(Located, _, Errors0),
    clause_problems(Errors0, Located, Errors, Warnings).

%   clause_problems(+Errors0, +Located, -Errors, -Warnings): Errors and Warnings
%   are those of a program with the same clauses, but a payload may change
%   predicates that it provides without a declaration.

clause_problems([Error|Errors], _, [Error|Errors], []).
clause_problems([], Located, Errors, Warnings) :-
    file_parts(payload, Located, Parts, _),
    part(rules, Parts, Rules),
    part(directives, Parts, Directives),
    mobile_predicates(Rules, Kinds, Errors0),
    findall(E, ( member(E, Errors0), \+ E = problem(_, _, undeclared(_)) ),
            Errors),
    findall(PI, member(PI-mobile, Kinds), Mobile),
    findall(W, ( apart_problem(Rules, Directives-[], W)
               ; lost_choice(Rules, own([], Mobile), W) ),
            Warnings).
