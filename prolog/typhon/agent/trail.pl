:- module(typhon_trail,
          [ trail_link/5,               % +Event, +Label, +State0, +Goals,
                                        % -State
            trail_enter/3,              % +Module, +Id, +Result
            trail_of/2,                 % +Module, -Raw
            trail_none/2,               % +State0, -State
            trail_verified/3            % +Id, +Raw, -Trail
          ]).

/** <module> Which hosts have had an agent, and what they did with it

Where processes have keys, each signs of an agent what it has received from
another process and what it handed on, and what the agent has entered there.
Each link is signed together with the signature of the one before. They are a
fact among the state of the agent:

    '$trail'(Links, Certificates)

Links, the newest first, are link(N, Event, C, Hex): the N-th, signed by who
shows the C-th of the Certificates. An event is

  - handed(Id, Hash, Hops, To, State, Goals)
  - received(Id, Hash, Hops, At, State, Goals)
  - entered(Id, Result)

Hash is that of the program, State and Goals are hashes. A host is accounted
for if what the next one received is what it handed on, to that address. What
an agent did while it stood on a host is the word of that host; and who was
visited twice can cut out what lies between.

The oldest links go when there are more than `links`.

*Threading*: the thread that sends, receives or runs the agent.
*/

:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, nth0/3, reverse/2, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../base/keys', 
              [ keys_certificate/2, keys_holder/3, keys_sign/3,
                keys_verify/4 ]).
:- use_module('../wire', [endpoint_address/1, endpoint_keys/1, term_text/2]).
:- use_module('../host', [address_parts/3, host_option/2]).
:- use_module(identity, [agent_home_endpoint/2]).

:- setting(links, positive_integer, 64,
           "So many links of the trail of an agent are kept").

%!  trail_link(+Event, +Label, +State0, +Goals, -State) is det.
%
%   State is State0, as of agent_state/2, with one link more, or State0
%   itself where there are no keys, or the host does without. Event is
%   handed(To) or received(At), Label is of(Host, Id, Hash, Hops).

trail_link(Event, Label, state(Empty, Clauses0), Goals, State) :-
    (   endpoint_keys(Keys),
        arg(1, Label, Host),
        \+ host_option(Host, trail(false))
    ->  taken_out(Clauses0, Raw0, Rest),
        event(Event, Label, Rest, Goals, What),
        linked(Keys, What, Raw0, Raw),
        State = state(Empty, [Raw|Rest])
    ;   State = state(Empty, Clauses0)
    ).

taken_out(Clauses, Raw, Rest) :-
    Raw = '$trail'(_, _),
    selectchk(Raw, Clauses, Rest),
    !.
taken_out(Clauses, '$trail'([], []), Clauses).

event(Event, of(_, Id, Hash, Hops), Clauses, Goals, What) :-
    Event =.. [Name, Where],
    sum(Clauses, State),
    sum(Goals, Doing),
    What =.. [Name, Id, Hash, Hops, Where, State, Doing].

%   The same wherever variables have other names.

sum(Term, Sum) :-
    copy_term(Term, Copy),
    numbervars(Copy, 0, _, [functor_name('$typhon_variable')]),
    term_text(Copy, Text),
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(octet)]),
    hash_atom(Bytes, Sum).

linked(Keys, What, '$trail'(Links0, Pems0), '$trail'(Links, Pems)) :-
    link_text(Links0, What, N, Text),
    keys_sign(Keys, Text, signature(Pem, Hex)),
    (   nth0(C, Pems0, Pem)
    ->  Pems = Pems0
    ;   append(Pems0, [Pem], Pems),
        length(Pems0, C)
    ),
    setting(links, Most),
    newest(Most, [link(N, What, C, Hex)|Links0], Links).

link_text(Before, What, N, Text) :-
    (   Before = [link(N0, _, _, Previous)|_]
    ->  N is N0+1
    ;   N = 0,
        Previous = none
    ),
    sum(typhon_trail(N, What, Previous), Sum),
    atom_concat('typhon trail ', Sum, Text).

newest(Most, Links0, Links) :-
    length(Links0, Count),
    (   Count > Most
    ->  length(Links, Most),
        append(Links, _, Links0)
    ;   Links = Links0
    ).

%!  trail_enter(+Module, +Id, +Result) is det.
%
%   The agent Id, whose module this is, enters Result, which can travel.
%
%   @error existence_error(keys, here)

trail_enter(Module, Id, Result) :-
    (   endpoint_keys(Keys)
    ->  trail_of(Module, Raw0),
        linked(Keys, entered(Id, Result), Raw0, Raw),
        dynamic(Module:'$trail'/2),
        retractall(Module:'$trail'(_, _)),
        assertz(Module:Raw)
    ;   existence_error(keys, here)
    ).

%!  trail_of(+Module, -Raw) is det.
%
%   What trail_verified/3 looks at, of the agent whose module this is.

trail_of(Module, Raw) :-
    (   '$c_current_predicate'(_, Module:'$trail'(_, _)),
        Module:'$trail'(Links, Certificates)
    ->  Raw = '$trail'(Links, Certificates)
    ;   Raw = '$trail'([], [])
    ).

%!  trail_none(+State0, -State) is det.
%
%   State is State0 without a trail: a clone begins its own.

trail_none(state(Empty, Clauses0), state(Empty, Clauses)) :-
    exclude(of_trail, Clauses0, Clauses).

of_trail('$trail'(_, _)).

                 /*******************************
                 *         VERIFICATION         *
                 *******************************/

%!  trail_verified(+Id, +Raw, -Trail) is det.
%
%   Trail is trail(Steps, Verdict). A step is step(N, Name, What), Name being
%   the host whose keys have signed it, and What handed(To), received(At) or
%   entered(Result). Verdict is `whole`, or unaccounted(Name): Name is the
%   host after which, or in whose hands, state or code have become what nobody
%   answers for; `nobody` where that is so from the beginning. It is since(N)
%   where all is well from the N-th link on, and those before are gone.
%
%   @error existence_error(keys, here)

trail_verified(Id, Raw, trail(Steps, Verdict)) :-
    (   endpoint_keys(Keys)
    ->  true
    ;   existence_error(keys, here)
    ),
    (   subsumes_term('$trail'(_, _), Raw),
        Raw = '$trail'(Links, Pems),
        is_list(Links),
        is_list(Pems)
    ->  reverse(Links, Oldest),
        all_steps(Oldest, with(Keys, Id, Pems), Steps, Verdict)
    ;   Steps = [],
        Verdict = unaccounted(nobody)
    ).

%   Where the oldest are gone, the first one that is left can only be known by
%   what the second one says of its signature.

all_steps([link(N, What, C, Hex)|Links], With, Steps, Verdict) :-
    integer(N),
    N > 0,
    !,
    steps(Links, With, since(link(N, What, C, Hex)), Steps, Verdict0),
    (   Verdict0 == whole
    ->  Since is N+1,
        Verdict = since(Since)
    ;   Verdict = Verdict0
    ).
all_steps(Links, With, Steps, Verdict) :-
    steps(Links, With, none, Steps, Verdict).

%   steps(+Links, +With, +Before, -Steps, -Verdict): Before is `none`,
%   since(Link) or before(Link, Name).

steps([], _, _, [], whole).
steps([Link|Links], With, Before, Steps, Verdict) :-
    (   signed_by(Link, With, Before, Name),
        follows(Link, With, Before, Name)
    ->  Link = link(N, What0, _, _),
        told(What0, What),
        Steps = [step(N, Name, What)|Steps1],
        steps(Links, With, before(Link, Name), Steps1, Verdict)
    ;   Steps = [],
        (   Before = before(_, Last)
        ->  Verdict = unaccounted(Last)
        ;   Verdict = unaccounted(nobody)
        )
    ).

signed_by(link(N, What, C, Hex), with(Keys, _, Pems), Before, Name) :-
    ground(N-C-Hex),
    nth0(C, Pems, Pem),
    before(Before, Last),
    link_text(Last, What, N, Text),
    keys_verify(Keys, Text, signature(Pem, Hex), host(Name)).

before(none, []).
before(since(Last), [Last]).
before(before(Last, _), [Last]).

follows(link(_, What, _, _), with(_, Id, _), since(_), _) :-
    !,
    arg(1, What, Id).
follows(link(_, What, _, _), with(Keys, Id, _), none, Name) :-
    !,
    arg(1, What, Id),
    \+ What = received(_, _, _, _, _, _),
    (   agent_home_endpoint(Id, Home),
        endpoint_address(Home)
    ->  own_name(Keys, Name)            % it began with us
    ;   true
    ).
follows(link(_, What, _, _), with(_, Id, _), before(Last, Before), Name) :-
    arg(1, What, Id),
    Last = link(_, Earlier, _, _),
    (   Earlier = handed(Id, Hash, Hops, To, State, Goals)
    ->  What = received(Id, Hash, Hops, At, State, Goals),
        address_parts(To, Host, _),     % a process may have several
        address_parts(At, Host, _)      % addresses
    ;   Name == Before,
        What \= received(_, _, _, _, _, _)
    ).

own_name(Keys, Name) :-
    keys_certificate(Keys, Own),
    keys_holder(Keys, Own, host(Name)).

told(entered(_, Result), entered(Result)) :-
    !.
told(Event, What) :-
    Event =.. [Name, _, _, _, Where|_],
    What =.. [Name, Where].
