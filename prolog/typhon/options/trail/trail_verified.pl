:- module(typhon_trail_verified,
          [ agent_trail/2,              % +Agent, -Trail
            trail_verified/3            % +Id, +Raw, -Trail
          ]).

/** <module> Verification of trails

A trail is parsed and verified as a whole, and only on request.

*Threading*: any thread; no state.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [existence_error/2]).
:- use_module('../keys',
              [keys_certificate/2, keys_holder/3, keys_verify/4, own_keys/1]).
:- use_module('../../kernel/base/text', [text_term/2]).
:- use_module('../../kernel/wire', [endpoint_address/1]).
:- use_module('../../kernel/host', [address_parts/3]).
:- use_module('../../kernel/agent', [agent/5, agent_home_endpoint/2]).
:- use_module('../../kernel/lifecycle', [agent_answer/3, question_answered/2]).
:- use_module(trail, [chain_links/2, trail_of/3, trail_signed/4]).

:- multifile typhon_questions:here/3.

%!  agent_trail(+Agent, -Trail) is det.
%
%   See the interface of the layer.

agent_trail(Agent, Trail) :-
    agent_answer(Agent, trail, Raw),
    trail_verified(Agent, Raw, Trail).

typhon_questions:here(trail, Agent, Asker) :-
    agent(Agent, _, Module, _, _),
    !,
    trail_of(Module, Agent, Raw),
    question_answered(Asker, answer(Raw)).

%!  trail_verified(+Id, +Raw, -Trail) is det.
%
%   Trail is trail(Steps, Verdict), as of agent_trail/2.  In unaccounted(Name)
%   Name is `nobody` if no step is valid.
%
%   @error existence_error(keys, here) this process has no keys

trail_verified(Id, Raw, trail(Steps, Verdict)) :-
    (   own_keys(Keys)
    ->  true
    ;   existence_error(keys, here)
    ),
    (   subsumes_term('$trail'(_, _, _, _), Raw),
        Raw = '$trail'(At, Chain, Pems, _),
        chain_links(Chain, Links),
        ground(Pems),
        is_list(Pems)
    ->  all_steps(Links, with(Keys, Id, Pems, At), Steps, Verdict)
    ;   Steps = [],
        Verdict = unaccounted(nobody)
    ).

%   If the oldest links were dropped, the first link left cannot be verified by
%   itself. Its successor proves it, since that was signed together with its
%   signature.

all_steps([Link|Links], With, Steps, Verdict) :-
    events(Link, N, Events),
    N > 0,
    !,
    length(Events, Count),
    Since is N+Count,
    steps(Links, With, since(Since, Link), Steps, Verdict0),
    (   Verdict0 == whole
    ->  Verdict = since(Since)
    ;   Verdict = Verdict0
    ).
all_steps(Links, With, Steps, Verdict) :-
    steps(Links, With, none, Steps, Verdict).

%   steps(+Links, +With, +Before, -Steps, -Verdict): Before describes the
%   verified links: `none`, since(N, Link) or before(N, Link, Event, Name),
%   where N is the number of the next event.

steps([], With, Before, [], Verdict) :-
    (   is_all(With, Before)
    ->  Verdict = whole
    ;   unaccounted(Before, Verdict)
    ).
steps([Link|Links], With, Before, Steps, Verdict) :-
    (   events(Link, N, Events),
        signed_by(Link, N, With, Before, Name),
        follow(Events, N, Link, With, Before, Name, Steps, After, Steps1)
    ->  steps(Links, With, After, Steps1, Verdict)
    ;   Steps = [],
        unaccounted(Before, Verdict)
    ).

unaccounted(before(_, _, _, Last), unaccounted(Last)) :-
    !.
unaccounted(_, unaccounted(nobody)).

%   is_all(+With, +Before): no link is missing.

is_all(with(_, _, _, At), Before) :-
    before(Before, N, Last),
    subsumes_term(at(N, _, _, Last, _), At).

events(link(Text, _, _), N, Events) :-
    catch(text_term(Text, Term), error(_, _), fail),
    subsumes_term(_-[_|_], Term),
    Term = N-Events,
    integer(N),
    is_list(Events),
    maplist(is_event, Events).

is_event(Event) :-
    subsumes_term(entered(_), Event),
    !.
is_event(Event) :-
    ground(Event),
    memberchk(Event, [handed(_, _), received(_), received(_, _)]),
    forall(arg(_, Event, Arg), atom(Arg)).

signed_by(Link, N, with(Keys, Id, Pems, _), Before, Name) :-
    Link = link(Text, Hex, C),
    memberchk(pem(C, _, Pem), Pems),
    before(Before, N, Last),
    trail_signed(Id, Text, Last, Signed),
    keys_verify(Keys, Signed, signature(Pem, Hex), host(Name)).

before(none, 0, none).
before(since(N, link(_, Hex, _)), N, Hex).
before(before(N, link(_, Hex, _), _, _), N, Hex).

%   follow(+Events, +N, +Link, +With, +Before, +Name, -Steps, -After, ?Rest)

follow([], _, _, _, After, _, Steps, After, Steps).
follow([Event|Events], N, Link, With, Before, Name,
       [step(N, Name, Told)|Steps], After, Rest) :-
    follows(Before, Event, With, Name),
    public_form(Event, Told),
    N1 is N+1,
    follow(Events, N1, Link, With, before(N1, Link, Event, Name), Name, Steps,
           After, Rest).

follows(since(_, _), _, _, _).
follows(none, Event, with(Keys, Id, _, _), Name) :-
    \+ is_received(Event, _),
    (   agent_home_endpoint(Id, Home),
        endpoint_address(Home)
    ->  own_name(Keys, Name)            % the agent began in this process
    ;   true
    ).
follows(before(_, _, Earlier, Before), Event, _, Name) :-
    (   Earlier = handed(To, What)
    ->  is_received(Event, What),
        arg(1, Event, At),
        address_parts(To, Host, _),     % a process may have several
        address_parts(At, Host, _)      % addresses
    ;   Name == Before,
        \+ is_received(Event, _)
    ).

is_received(received(_), _).
is_received(received(_, What), What).

own_name(Keys, Name) :-
    keys_certificate(Keys, Own),
    keys_holder(Keys, Own, host(Name)).

public_form(received(At, _), received(At)) :-
    !.
public_form(handed(To, _), handed(To)) :-
    !.
public_form(Event, Event).
