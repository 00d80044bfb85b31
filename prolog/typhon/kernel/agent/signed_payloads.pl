:- module(typhon_signed_payloads,
          [ payload_mark/2,             % +Payload, -Mark
            payload_marked/2,           % +Module, +Marks
            payload_unmarked/2,         % +Module, +Name
            payload_marks/2,            % +Module, -Marks
            payload_admitted/3          % +Host, +Payload, +Clauses
          ]).

/** <module> Payloads that an author has signed

The signature of a payload is a fact among the state of the agent,

    '$signed'(Name, Signature)

so it goes where the payload goes. A host with `authors(Names)` admits agents
whose payloads are all as one of these has signed them: what has changed
since is not.

*Threading*: any thread; the module of an agent belongs to its worker.
*/

:- use_module(library(lists), [member/2]).
:- use_module('../program', [payload_hash/2, payload_signature/2]).
:- use_module('../host', [host_option/2, signature_by/3]).
:- use_module(agent_module, [agent_state/2]).
:- use_module(life, [life_payloads/2]).

%!  payload_mark(+Payload, -Mark) is semidet.
%!  payload_marked(+Module, +Marks:list) is det.
%!  payload_unmarked(+Module, +Name) is det.
%!  payload_marks(+Module, -Marks:list) is det.
%
%   Mark is the fact that goes with Payload, if its signature is known here.
%   The agent with this module has these; it has none for Name any more; it has
%   these and no others.

payload_mark(Payload, '$signed'(Name, Signature)) :-
    payload_signature(Payload, Signature),
    Payload = payload(Name, _, _).

payload_marked(_, []) :-
    !.
payload_marked(Module, Marks) :-
    dynamic(Module:'$signed'/2),
    forall(member(Mark, Marks), assertz(Module:Mark)).

payload_unmarked(Module, Name) :-
    (   '$c_current_predicate'(_, Module:'$signed'(_, _))
    ->  retractall(Module:'$signed'(Name, _))
    ;   true
    ).

payload_marks(Module, Marks) :-
    Mark = '$signed'(_, _),
    (   '$c_current_predicate'(_, Module:Mark)
    ->  findall(Mark, Module:Mark, Marks)
    ;   Marks = []
    ).

:- multifile typhon_host_parts:part/4.

typhon_host_parts:part(admit_program, Host, 60, typhon_signed_payloads:forbids) :-
    host_option(Host, authors(_)).

:- public forbids/4.

forbids(_, entrant(_, _, Life, State, _), Host, refused(unsigned)) :-
    \+ payloads_admitted(Host, Life, State).

%   State is as of agent_state/2, or module(Module).

payloads_admitted(Host, Life, State) :-
    life_payloads(Life, Payloads),
    Payloads \== [],
    !,
    state_clauses(State, Clauses),
    forall(member(Name-PIs, Payloads),
           payload_admitted(Host, payload(Name, PIs, Clauses), Clauses)).
payloads_admitted(_, _, _).

state_clauses(state(_, Clauses), Clauses).
state_clauses(module(Module), Clauses) :-
    agent_state(Module, state(_, Clauses)).

%!  payload_admitted(+Host, +Payload, +Clauses) is semidet.
%
%   Host, of this process, lets in an agent with this Payload, Clauses being
%   among its state.

payload_admitted(Host, Payload, Clauses) :-
    (   host_option(Host, authors(Authors))
    ->  Payload = payload(Name, _, _),
        payload_hash(Payload, Hash),
        member(Mark, Clauses),
        subsumes_term('$signed'(Name, _), Mark),
        arg(2, Mark, Signature),
        signature_by(Authors, Hash, Signature)
    ;   true
    ),
    !.
