:- module(typhon_guard, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../kernel/program',
              [code_known/2, code_make/3, code_program/2, sent_program/2]).
:- use_module('../kernel/host',
              [ context_now/2, host/3, host_option/2, parts_call/3,
                place_host/2, place_service/2 ]).
:- use_module(guard/allowed, [policy_read/1]).
:- use_module(guard/guard_calls, [guard_call/5, guard_goals/4]).
:- use_module(guard/guard_clauses,
              [ guard_clauses/3, guard_declares/2, guard_program/3,
                guard_refuses/4, guard_state/3 ]).

/** <module> Sandboxed hosts: the option policy(Policy)

Policy is `trusted`, `guarded`, or a file of rules, see policy_read/1.  On a
host with another policy than `trusted` agents run the variant guarded(Policy)
of their program, see typhon_agent_module.  Their modules inherit from a view
of the place that has nothing but its services, see place_service/2.  The
program of an agent is checked before the agent enters.

The rewritten program is made once per program and policy in a process, and is
removed after the program.

*Threading*: any thread; a mutex protects the table of variants, that of
host_start/2 those of views.
*/

:- multifile
    typhon_checks:objection/3,
    typhon_code:retiring/1,
    typhon_gate:forbidden/2,
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:ends/1,
    typhon_host_parts:part/4,
    typhon_host_parts:untrusted/1,
    typhon_options:declared/4,
    typhon_place:serves/2,
    typhon_agent_module:called/5,
    typhon_agent_module:clauses/3,
    typhon_agent_module:declares/2,
    typhon_agent_module:goals/4,
    typhon_agent_module:program/3,
    typhon_agent_module:state/3,
    typhon_agent_module:variant/2.

:- dynamic
    view_now/2,                 % Host, View
    view/3,                     % View, Host, Policy
    variant/3,                  % Hash, Policy, Module
    retired/1.                  % Module: destroyed at the next retirement

typhon_options:declared(host_option, policy(Policy), text, Policy).
typhon_options:declared(check_option, policy(Policy), text, Policy).

                /*******************************
                *             VIEWS            *
                *******************************/

typhon_host_parts:begins(Host, Place, Options) :-
    (   option(policy(Policy), Options)
    ->  view_set(Host, Place, Policy)
    ;   true
    ).

typhon_host_parts:changeable(policy(_)).

typhon_host_parts:untrusted(policy(Policy)) :-
    Policy \== trusted.

%   This runs before the option is set, so a wrong file of rules changes
%   nothing.

typhon_host_parts:changes(policy(Policy), Host) :-
    host(Host, _, Place),
    view_set(Host, Place, Policy).

typhon_host_parts:part(view, Host, 10, View) :-
    view_now(Host, View).

%   view_set(+Host, +Place, +Policy): agents that are on Host keep their policy.
%
%   @error the errors of policy_read/1

view_set(Host, _, trusted) :-
    !,
    retractall(view_now(Host, _)).
view_set(Host, Place, Policy) :-
    policy_read(Policy),
    flag(typhon_guard, N, N+1),
    atomic_list_concat(['view ', Host, ' ', N], View),
    set_module(View:class(temporary)),
    set_module(View:base(typhon_vocabulary)),
    forall(place_service(Place, PI), show(Place, View, PI)),
    assertz(view(View, Host, Policy)),
    asserta(view_now(Host, View)),
    forall(( view_now(Host, Old), Old \== View ),
           retractall(view_now(Host, Old))).

typhon_place:serves(Place, PI) :-
    place_host(Place, Host),
    view_now(Host, View),
    show(Place, View, PI).

show(Place, View, Name/Arity) :-
    place_host(Place, Host),
    functor(Head, Name, Arity),
    abolish(View:Name/Arity),
    assertz((View:Head :- typhon_guard:service(Host, Name/Arity, Head))).

:- public service/3.

service(Host, PI, Goal) :-
    context_now(Host, Id),
    parts_call(acts, Host, [Id, service(PI)]),
    host(Host, _, Place),
    call(Place:Goal).

typhon_host_parts:ends(Host) :-
    retractall(view_now(Host, _)),
    views_end(Host).

views_end(Host) :-
    findall(View, view(View, Host, _), Views),
    retractall(view(_, Host, _)),
    maplist('$destroy_module', Views).

                /*******************************
                *          ADMISSION           *
                *******************************/

typhon_host_parts:part(admit, Host, 30, typhon_guard:forbids(Policy)) :-
    once(host_option(Host, policy(Policy))),
    Policy \== trusted.

typhon_host_parts:part(new_program, Host, 30,
                       typhon_guard:may_receive(Policy)) :-
    once(host_option(Host, policy(Policy))),
    Policy \== trusted.

:- public
    forbids/5,
    may_receive/4.

forbids(Policy, From, Entrant, _, refused(Reason)) :-
    catch(( check_entrant(From, Entrant, Policy), fail ), error(Formal, Where),
          forbidden(error(Formal, Where), Reason)).

%   check_entrant(+From, +Entrant, +Policy): check the program alone.  A
%   program that comes with the agent is checked before it is installed, since
%   that loads its libraries.  State and goals are checked when the agent is
%   installed.
%
%   @error the errors that forbidden/2 lists

check_entrant(_, entrant(_, Hash, _, _, _), Policy) :-
    code_known(Hash, _),
    !,
    guarded_module(Policy, Hash, _).
check_entrant(from(_, Sent, _), _, Policy) :-
    check_sent(Policy, Sent).

%   forbidden(+Ball, -Reason): Ball is an error by which a host refuses code.

typhon_gate:forbidden(Ball, Reason) :-
    forbidden(Ball, Reason).

forbidden(error(permission_error(call, sandboxed, Culprit), _),
          policy(Culprit)).
forbidden(error(resource_error(clause_cells), _), policy(clause_cells)).

%   may_receive(+Policy, +Host, +Id, +New): the agent Id may get the program New,
%   Hash-Sent.

may_receive(Policy, _, _, _-Sent) :-
    check_sent(Policy, Sent).

%   check_sent(+Policy, +Sent): check a program that is not installed yet, since
%   its libraries alone may be forbidden here.  Sent is that of code_receive/2.
%
%   @error permission_error(call, sandboxed, Culprit)

check_sent(Policy, Sent) :-
    (   sent_program(Sent, Program),
        acyclic_term(Program)
    ->  guard_program(Policy, Program, _)
    ;   true                            % no program, or it follows later
    ).

                /*******************************
                *           VARIANTS           *
                *******************************/

typhon_agent_module:variant(View, guarded(Policy)) :-
    view(View, _, Policy).

typhon_agent_module:program(guarded(Policy), Hash, Module) :-
    guarded_module(Policy, Hash, Module).

typhon_agent_module:state(guarded(Policy), State0, State) :-
    guard_state(Policy, State0, State).

typhon_agent_module:goals(guarded(Policy), Program, Goals0, Goals) :-
    guard_goals(Policy, Program, Goals0, Goals).

typhon_agent_module:clauses(guarded(Policy), Clauses0, Clauses) :-
    guard_clauses(Policy, Clauses0, Clauses).

typhon_agent_module:declares(guarded(Policy), PI) :-
    guard_declares(Policy, PI).

typhon_agent_module:called(guarded(Policy), Module, Closure, Extra, Goal) :-
    guard_call(Policy, Module, Closure, Extra, Goal).

%   guarded_module(+Policy, +Hash, -Module): Module has the installed program
%   Hash, rewritten for Policy.
%
%   @error permission_error(call, sandboxed, Culprit)

guarded_module(Policy, Hash, Module) :-
    variant(Hash, Policy, Module0),
    !,
    Module = Module0.
guarded_module(Policy, Hash, Module) :-
    code_known(Hash, Kinds),
    code_program(Hash, Program0),
    guard_program(Policy, Program0, Program),
    with_mutex(typhon_guard,
               make(Hash, Policy, Program, Kinds, Module)).

make(Hash, Policy, _, _, Module) :-
    variant(Hash, Policy, Module0),
    !,
    Module = Module0.
make(Hash, Policy, Program, Kinds, Module) :-
    code_make(Program, Kinds, Module),
    assertz(variant(Hash, Policy, Module)).

typhon_code:retiring(Hash) :-
    with_mutex(typhon_guard, retire(Hash)).

retire(Hash) :-
    findall(Module, retired(Module), Before),
    retractall(retired(_)),
    maplist('$destroy_module', Before),
    findall(Module, variant(Hash, _, Module), Modules),
    retractall(variant(Hash, _, _)),
    forall(member(Module, Modules), assertz(retired(Module))).

typhon_checks:objection(Options, program(Rules, Libraries), Objection) :-
    option(policy(Policy), Options),
    Policy \== trusted,
    policy_read(Policy),
    objection(Policy, Rules, Libraries, Objection).

objection(Policy, Rules, _, Where-Formal) :-
    findall(Rule, member(Rule-_, Rules), Clauses),
    member(Rule-Where, Rules),
    guard_refuses(Policy, Clauses, Rule, Formal).
objection(Policy, _, Libraries, _-Formal) :-
    findall(Library-all, member(Library, Libraries), Imports),
    catch(( guard_program(Policy, program(x, [], Imports, []), _), fail ),
          error(Formal, _), true).
