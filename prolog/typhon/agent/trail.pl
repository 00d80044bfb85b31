:- module(typhon_trail,
          [ trail_link/5,               % +Event, +Label, +State0, +Goals,
                                        % -State
            trail_enter/3,              % +Module, +Id, +Result
            trail_of/2,                 % +Module, -Raw
            trail_none/2,               % +State0, -State
            trail_signed/3              % +Text, +Before, -Signed
          ]).

/** <module> Which hosts have had an agent, and what they did with it

Where processes have keys, each signs of an agent what it has received from
another process and what it handed on, and what the agent has entered there.
Each link is signed together with the signature of the one before. They are a
fact among the state of the agent:

    '$trail'(Next, Links, Certificates, Pending)

Links, the newest first, are link(Text, Hex, C): Text is that of N-Events, the
N-th event and perhaps others, Hex the signature of who shows the certificate
C. They are strings, so that nobody has to look into them on the way. The next
event has the number Next. An event is

  - handed(Id, Hash, Hops, To, State, Goals)
  - received(Id, Hash, Hops, At, State, Goals)
  - entered(Id, Result)

Hash is that of the program, State and Goals are hashes. A host is accounted
for if what the next one received is what it handed on, to that address. What
an agent did while it stood on a host is the word of that host; and who was
visited twice can cut out what lies between.

To sign costs more than all else. What was received is Pending, or `none`, and
is signed with what comes next, on the same host; it is the word of that host
then as it would have been before.

The oldest links go when there are more than `links`.

*Threading*: the thread that sends, receives or runs the agent.
*/

:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../base/keys', [keys_sign/3]).
:- use_module('../wire', [endpoint_keys/1, term_text/2]).
:- use_module('../host', [host_option/2]).

:- setting(links, positive_integer, 64,
           "So many links of the trail of an agent are kept").

%!  trail_link(+Event, +Label, +State0, +Goals, -State) is det.
%
%   State is State0, as of agent_state/2, with one link more, or State0
%   itself where there are no keys, or the host does without. Event is
%   handed(To) or received(At), Label is of(Host, Id, Hash, Hops).

trail_link(Event, Label, State0, Goals, State) :-
    endpoint_keys(Keys),
    State0 = state(Empty, Clauses0),
    taken_out(Clauses0, Raw0, Rest),
    arg(1, Label, Host),
    (   host_option(Host, trail(false))
    ->  settled(Keys, Raw0, Raw)
    ;   event(Event, Label, Rest, Goals, What),
        happens(What, Keys, Raw0, Raw)
    ),
    Raw \== Raw0,
    !,
    State = state(Empty, [Raw|Rest]).
trail_link(_, _, State, _, State).

taken_out(Clauses, Raw, Rest) :-
    Raw = '$trail'(_, _, _, _),
    selectchk(Raw, Clauses, Rest),
    !.
taken_out(Clauses, Raw, Clauses) :-
    no_trail(Raw).

no_trail('$trail'(0, [], [], none)).

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
    text_sum(Text, Sum).

text_sum(Text, Sum) :-
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(octet)]),
    hash_atom(Bytes, Sum).

%   happens(+What, +Keys, +Raw0, -Raw): What waits to be signed, or is signed
%   with what waits.

happens(What, Keys, Raw0, Raw) :-
    What = received(_, _, _, _, _, _),
    !,
    settled(Keys, Raw0, '$trail'(Next, Links, Pems, _)),
    Raw = '$trail'(Next, Links, Pems, What).
happens(What, Keys, '$trail'(Next, Links, Pems, Pending), Raw) :-
    ( Pending == none -> Events = [What] ; Events = [Pending, What] ),
    linked(Events, Keys, '$trail'(Next, Links, Pems, none), Raw).

%   settled(+Keys, +Raw0, -Raw): nothing waits.

settled(Keys, '$trail'(Next, Links, Pems, Pending), Raw) :-
    Pending \== none,
    !,
    linked([Pending], Keys, '$trail'(Next, Links, Pems, none), Raw).
settled(_, Raw, Raw).

linked(Events, Keys, '$trail'(N, Links0, Pems0, _), Raw) :-
    term_text(N-Events, Text),
    trail_signed(Text, Links0, Signed),
    keys_sign(Keys, Signed, signature(Pem, Hex)),
    (   member(C-Pem0, Pems0),
        Pem0 == Pem
    ->  Pems1 = Pems0
    ;   C = N,
        Pems1 = [C-Pem|Pems0]
    ),
    length(Events, Count),
    Next is N+Count,
    newest([link(Text, Hex, C)|Links0], Pems1, Links, Pems),
    Raw = '$trail'(Next, Links, Pems, none).

%!  trail_signed(+Text:string, +Before:list, -Signed) is det.
%
%   What is signed of a link with this Text, Before being those before.

trail_signed(Text, Before, Signed) :-
    (   Before = [link(_, Hex, _)|_]
    ->  true
    ;   Hex = none
    ),
    string_concat(Hex, Text, All),
    text_sum(All, Sum),
    atom_concat('typhon trail ', Sum, Signed).

%   newest(+Links0, +Pems0, -Links, -Pems): with the last link that a host has
%   signed its certificate goes.

newest(Links0, Pems0, Links, Pems) :-
    length(Links0, Count),
    setting(links, Most),
    (   Count > Most
    ->  length(Links, Most),
        append(Links, Gone, Links0),
        exclude(of_none(Links, Gone), Pems0, Pems)
    ;   Links = Links0,
        Pems = Pems0
    ).

of_none(Links, Gone, C-_) :-
    memberchk(link(_, _, C), Gone),
    \+ memberchk(link(_, _, C), Links).

%!  trail_enter(+Module, +Id, +Result) is det.
%
%   The agent Id, whose module this is, enters Result, which can travel.
%
%   @error existence_error(keys, here)

trail_enter(Module, Id, Result) :-
    (   endpoint_keys(Keys)
    ->  raw(Module, Raw0),
        happens(entered(Id, Result), Keys, Raw0, Raw),
        dynamic(Module:'$trail'/4),
        retractall(Module:'$trail'(_, _, _, _)),
        assertz(Module:Raw)
    ;   existence_error(keys, here)
    ).

%!  trail_of(+Module, -Raw) is det.
%
%   What trail_verified/3 looks at, of the agent whose module this is.

trail_of(Module, Raw) :-
    raw(Module, Raw0),
    (   endpoint_keys(Keys)
    ->  settled(Keys, Raw0, Raw)
    ;   Raw = Raw0
    ).

raw(Module, Raw) :-
    Raw = '$trail'(_, _, _, _),
    (   '$c_current_predicate'(_, Module:Raw),
        call(Module:Raw)
    ->  true
    ;   no_trail(Raw)
    ).

%!  trail_none(+State0, -State) is det.
%
%   State is State0 without a trail: a clone begins its own.

trail_none(state(Empty, Clauses0), state(Empty, Clauses)) :-
    exclude(of_trail, Clauses0, Clauses).

of_trail(Clause) :-
    subsumes_term('$trail'(_, _, _, _), Clause).
