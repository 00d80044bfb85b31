:- module(typhon_authors, []).

/** <module> Admission by the authors of programs and payloads

A host with `authors(Names)` admits an agent, from any process, only if one of
these authors has signed its program and its payloads.

The signature of a payload is a fact in the state of the agent,

    '$signed'(Name, Signature)

so it moves with the payload.  A payload is admitted only as the author signed
it: a payload that has changed since is refused.

*Threading*: any thread; the module of an agent belongs to its worker.
*/

:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/on_demand', [on_demand_call/3]).
:- use_module('../../kernel/program', [code_unwrapped/3]).
:- use_module('../../kernel/host', [host_option/2]).
:- use_module('../../kernel/agent',
              [agent_state/2, life_payloads/2]).
:- use_module('../keys', [own_keys/1]).
:- use_module(signatures,
              [ payload_hash/2, payload_signature/2, program_author/3,
                signature_author/4, signature_keep/2 ]).

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:part/4,
    typhon_options:declared/4,
    typhon_order_client:attach_order/2,
    typhon_orders:carried_out/3,
    typhon_payloads:mark/2,
    typhon_payloads:unmarked/2.

typhon_options:declared(host_option, authors(Names), list(atom), Names).

%   Without a certificate authority no signature is valid.

typhon_host_parts:begins(_, _, Options) :-
    (   \+ memberchk(authors(_), Options)
    ->  true
    ;   own_keys(_)
    ->  true
    ;   existence_error(host_option, tls)
    ).

typhon_host_parts:changeable(authors(_)).

typhon_host_parts:part(Phase, Host, Order, typhon_authors:Closure) :-
    closure(Phase, Order, Closure),
    host_option(Host, authors(_)).

closure(admit_program, 60, payloads_forbid).
closure(admit_program, 70, program_forbids).
closure(new_program, 20, may_get).
closure(payload, 10, payload_forbids).

:- public payloads_forbid/4, program_forbids/4, may_get/3, payload_forbids/4.

%   If the program was not sent along, its signature may arrive with it later.

program_forbids(From, entrant(_, Hash, _, _, _), Host, Verdict) :-
    host_option(Host, authors(Authors)),
    \+ signed_by(Authors, Hash),
    (   From = from(_, known, _)
    ->  Verdict = need_program
    ;   Verdict = refused(unsigned)
    ).

%   may_get(+Host, +Id, +New): the agent Id may get the program New, Hash-Sent.
%   Its signature may come with it.

may_get(Host, Id, Hash-Sent) :-
    host_option(Host, authors(Authors)),
    code_unwrapped(Sent, _, Extras),
    (   signed_by(Authors, Hash)
    ->  true
    ;   member(signature(Signature), Extras),
        signature_by(Authors, Hash, Signature)
    ->  true
    ;   permission_error(change, agent_program, Id)
    ).

%   signed_by(+Authors, +Hash): one of Authors has signed the program Hash.

signed_by(Authors, Hash) :-
    own_keys(Keys),
    program_author(Keys, Hash, Author),
    memberchk(Author, Authors),
    !.

%   signature_by(+Authors, +Hash, +Signature): Signature, which may be any term,
%   is the signature of one of Authors for Hash.

signature_by(Authors, Hash, Signature) :-
    own_keys(Keys),
    signature_author(Keys, Hash, Signature, Author),
    memberchk(Author, Authors),
    !.

                /*******************************
                *           PAYLOADS           *
                *******************************/

payloads_forbid(_, entrant(_, _, Life, State, _), Host, refused(unsigned)) :-
    \+ payloads_admitted(Host, Life, State).

payload_forbids(new, Payload, Host, unsigned) :-
    findall(Mark, mark(Payload, Mark), Marks),
    \+ payload_admitted(Host, Payload, Marks).
payload_forbids(module(Module), Payload, Host, unsigned) :-
    marks(Module, Marks),
    \+ payload_admitted(Host, Payload, Marks).

marks(Module, Marks) :-
    Mark = '$signed'(_, _),
    (   '$c_current_predicate'(_, Module:Mark)
    ->  findall(Mark, Module:Mark, Marks)
    ;   Marks = []
    ).

%   State is that of agent_state/2, or module(Module).

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

%   payload_admitted(+Host, +Payload, +Clauses): one of Clauses, in the state of
%   the agent, is a valid signature of Payload by an author that Host admits.

payload_admitted(Host, Payload, Clauses) :-
    host_option(Host, authors(Authors)),
    Payload = payload(Name, _, _),
    payload_hash(Payload, Hash),
    member(Mark, Clauses),
    subsumes_term('$signed'(Name, _), Mark),
    arg(2, Mark, Signature),
    signature_by(Authors, Hash, Signature),
    !.

%   A new payload gets its mark, the fact '$signed'(Name, Signature), if this
%   process knows its signature.

typhon_payloads:mark(Payload, Mark) :-
    mark(Payload, Mark).

mark(Payload, '$signed'(Name, Signature)) :-
    payload_signature(Payload, Signature),
    Payload = payload(Name, _, _).

typhon_payloads:unmarked(Module, Name) :-
    '$c_current_predicate'(_, Module:'$signed'(_, _)),
    retractall(Module:'$signed'(Name, _)).

%   The order to attach a payload carries its signature.

typhon_order_client:attach_order(Payload, attach(Payload, Signature)) :-
    payload_signature(Payload, Signature).

typhon_orders:carried_out(attach(Payload, Signature), Agent, ok) :-
    payload_hash(Payload, Hash),
    signature_keep(Hash, Signature),
    on_demand_call(payload, any,
                   typhon_payloads:agent_attach(Agent, Payload)).
