:- module(typhon_guard_admission, []).
:- use_module('../program', [code_check/3, code_guarded/3, code_module/2]).
:- use_module('../host', [host/3, host_option/2, place_front/3]).

/** <module> Hosts that guard look through a program before it enters

*Threading*: any thread.
*/

:- multifile
    typhon_gate:forbidden/2,
    typhon_host_parts:part/4.

typhon_host_parts:part(admit, Host, 30, typhon_guard_admission:forbids) :-
    host_option(Host, policy(Policy)),
    Policy \== trusted.

:- public forbids/4.

forbids(From, Entrant, Host, refused(Reason)) :-
    host(Host, _, Place),
    place_front(Place, _, Policy),
    catch(( looked_through(From, Entrant, Policy), fail ), error(Formal, Where),
          forbidden(error(Formal, Where), Reason)).

%   looked_through(+From, +Entrant, +Policy): the program alone.  One that is
%   sent is checked before it is installed, since that loads its libraries.
%   State and goals are checked when the agent is installed.
%
%   @error what forbidden/2 knows

looked_through(_, entrant(_, Hash, _, _, _), Policy) :-
    code_module(Hash, _),
    !,
    code_guarded(Policy, Hash, _).
looked_through(from(_, Program, _), entrant(_, Hash, _, _, _), Policy) :-
    code_check(Policy, Hash, Program).

%   forbidden(+Ball, -Reason): Ball says that a host does not let in what it is
%   not to run.

typhon_gate:forbidden(Ball, Reason) :-
    forbidden(Ball, Reason).

forbidden(error(permission_error(call, sandboxed, Culprit), _),
          policy(Culprit)).
forbidden(error(resource_error(clause_cells), _), policy(clause_cells)).
