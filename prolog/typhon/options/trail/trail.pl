:- module(typhon_trail,
          [ trail_link/5,               % +Event, +Label, +State0, +Goals,
                                        % -State
            trail_enter/3,              % +Module, +Id, +Result
            trail_of/3,                 % +Module, +Id, -Raw
            trail_signed/4,             % +Id, +Text, +Last, -Signed
            chain_links/2               % +Text, -Links
          ]).
:- use_module(library(apply), [exclude/3, include/3, maplist/2]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [last/2, select/3, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../keys', [keys_sign/3, own_keys/1]).
:- use_module('../../kernel/base/text', [term_text/2]).
:- use_module('../../kernel/host', [host_option/2]).

/** <module> The trail: a chain of signatures of the hosts that an agent visits

Each process that has keys signs an agent as it received it from another
process, the agent as it handed it on, and the results that the agent has
entered there.  Each link is signed together with the signature of the previous
link.  The links are a fact in the state of the agent:

    '$trail'(At, Chain, Certificates, Pending)

Chain is one string, which hosts do not parse, so its cost in transit and
storage depends little on the number of links.  A link link(Text, Hex, C) has
the Text of N-Events, the N-th event and perhaps its successors, the signature
Hex, and the number C of the certificate pem(C, Last, Pem) of the signer; Last
is the last link of that signer.  In Chain a link is

    00000123Hex C Text

The first eight digits are the number of characters that follow.  The oldest
link comes first.  At is at(Next, Made, Kept, Hex, Handed): the number of the
next event, the number of links that were made, the number of links in Chain,
the signature of the last link, and the hash What of a last event handed(To,
What), or `none`.  An event is

  - handed(To, What)
  - received(At, What), or received(At) if What is the hash that was handed on
  - entered(Result)

What is a hash of the agent: its program, the number of its hops, its state and
its goals.  The id of the agent is also signed.  A host is accounted for if the
next host received the same hash, at the address to which it was handed.  A
trail does not prove what an agent did on a host: that is a claim of that host.
A host that an agent visits twice can cut out the links in between.

Signing is the most expensive part.  So a received event is Pending at first,
and is signed together with the next event on the same host; it is a claim of
that host in either case.  Pending is `none` if there is no such event.

The oldest links are dropped when Chain has more than the setting `links`.

A host can change the trail of an agent at will while the agent is there.  An
inconsistent trail stays as it is, and gets no further links.

*Threading*: the thread that sends, receives or runs the agent.
*/

:- multifile
    typhon_host_parts:changeable/1,
    typhon_host_parts:part/4,
    typhon_on_demand:joins/2,
    typhon_options:declared/4,
    typhon_words:enters/3.

typhon_on_demand:joins(keys, any).

typhon_options:declared(host_option, trail(X), boolean, X).

typhon_host_parts:changeable(trail(_)).

typhon_host_parts:part(Phase, _, 10, typhon_trail:Closure) :-
    closure(Phase, Closure),
    own_keys(_).

closure(departs, departs).
closure(arrives, arrives).
closure(cloned, without_trail).
closure(copied, without_trail).

:- public departs/4, arrives/4, without_trail/4.

departs(Host, hop(Id, Hash, Hops, Goals, To), State0, State) :-
    trail_link(handed(To), of(Host, Id, Hash, Hops), State0, Goals, State).

arrives(Host, hop(Id, Hash, Hops, Goals, from(_, Address)), State0, State) :-
    trail_link(received(Address), of(Host, Id, Hash, Hops), State0, Goals,
               State).

%   A clone begins its own trail, and so does an agent from a restore point.

without_trail(_, _, state(Empty, Clauses0), state(Empty, Clauses)) :-
    exclude(of_trail, Clauses0, Clauses).

of_trail(Clause) :-
    subsumes_term('$trail'(_, _, _, _), Clause).

:- setting(links, positive_integer, 32,
           "Links that are kept of the trail of an agent").

%!  trail_link(+Event, +Label, +State0, +Goals, -State) is det.
%
%   State is State0, see agent_state/2, with Event added to the trail; or State0
%   itself if the process has no keys, or the host has the option trail(false).
%   Event is handed(To) or received(At), Label is of(Host, Id, Hash, Hops).

trail_link(Event, Label, State0, Goals, State) :-
    own_keys(Keys),
    State0 = state(Empty, Clauses0),
    split_trail(Clauses0, Raw0, Rest),
    drop_foreign_pending(Event, Raw0, Raw1),
    Label = of(Host, Id, _, _),
    (   host_option(Host, trail(false))
    ->  sign_pending(Keys, Id, Raw1, Raw)
    ;   event(Event, Label, Rest, Goals, Happened),
        add_event(Happened, Keys, Id, Raw1, Raw)
    ),
    Raw \== Raw0,
    !,
    State = state(Empty, [Raw|Rest]).
trail_link(_, _, State, _, State).

split_trail(Clauses, Raw, Rest) :-
    Raw = '$trail'(_, _, _, _),
    selectchk(Raw, Clauses, Rest),
    !.
split_trail(Clauses, Raw, Clauses) :-
    no_trail(Raw).

no_trail('$trail'(at(0, 0, 0, none, none), "", [], none)).

%   drop_foreign_pending(+Event, +Raw0, -Raw): drop the pending event of the
%   previous host. A host that hands on an agent has signed its own events; this
%   process does not sign them for it.

drop_foreign_pending(received(_), '$trail'(At, Chain, Pems, _),
                     '$trail'(At, Chain, Pems, none)) :-
    !.
drop_foreign_pending(_, Raw, Raw).

%   is_consistent(+Raw): Raw has the form to which a link can be added.

is_consistent(Raw) :-
    ground(Raw),
    Raw = '$trail'(at(Next, Made, Kept, Last, Handed), Chain, Pems, Pending),
    maplist(integer, [Next, Made, Kept]),
    maplist(atomic, [Last, Handed]),
    string(Chain),
    is_list(Pems),
    memberchk(Pending, [none, received(_), received(_, _)]).

event(Event0, of(_, _, Hash, Hops), Clauses, Goals, Event) :-
    Event0 =.. [Name, Where],
    term_sum(what(Hash, Hops, Clauses, Goals), What),
    Event =.. [Name, Where, What].

%   The hash does not depend on the identity of variables.

term_sum(Term, Sum) :-
    copy_term(Term, Copy),
    numbervars(Copy, 0, _, [functor_name('$typhon_variable')]),
    term_text(Copy, Text),
    text_sum(Text, Sum).

text_sum(Text, Sum) :-
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(octet)]),
    hash_atom(Bytes, Sum).

%   add_event(+Event, +Keys, +Id, +Raw0, -Raw): Event becomes pending, or is
%   signed together with the pending event.

add_event(received(Where, What), _, _, Raw0, Raw) :-
    is_consistent(Raw0),
    !,
    Raw0 = '$trail'(At, Chain, Pems, none),
    (   arg(5, At, What)
    ->  Pending = received(Where)
    ;   Pending = received(Where, What)
    ),
    Raw = '$trail'(At, Chain, Pems, Pending).
add_event(Event, Keys, Id, Raw0, Raw) :-
    Raw0 = '$trail'(_, _, _, Pending),
    ( Pending == none -> Events = [Event] ; Events = [Pending, Event] ),
    add_link(Events, Keys, Id, Raw0, Raw).

%   sign_pending(+Keys, +Id, +Raw0, -Raw): no event is pending in Raw.

sign_pending(Keys, Id, Raw0, Raw) :-
    Raw0 = '$trail'(_, _, _, Pending),
    (   Pending == none
    ->  Raw = Raw0
    ;   add_link([Pending], Keys, Id, Raw0, Raw)
    ).

add_link(Events, Keys, Id, Raw0, Raw) :-
    is_consistent(Raw0),
    Raw0 = '$trail'(at(N, Made0, Kept0, Last, _), Chain0, Pems0, _),
    term_text(N-Events, Text),
    trail_signed(Id, Text, Last, Signed),
    keys_sign(Keys, Signed, signature(Pem, Hex)),
    certificate_number(Pem, Made0, Pems0, C, Pems1),
    Kept1 is Kept0+1,
    setting(links, Most),
    chain_add(link(Text, Hex, C), Kept1-Chain0, Most, Kept-Chain),
    !,
    length(Events, Count),
    Next is N+Count,
    Made is Made0+1,
    First is Made-Kept,
    include(signed_since(First), Pems1, Pems),
    ( last(Events, handed(_, What)) -> Handed = What ; Handed = none ),
    Raw = '$trail'(at(Next, Made, Kept, Hex, Handed), Chain, Pems, none).
add_link(_, _, _, Raw, Raw).

certificate_number(Pem, Link, Pems0, C, [pem(C, Link, Pem)|Pems]) :-
    select(pem(C0, _, Pem0), Pems0, Pems),
    Pem0 == Pem,
    integer(C0),
    !,
    C = C0.
certificate_number(Pem, Link, Pems, Link, [pem(Link, Link, Pem)|Pems]).

%   A certificate is dropped with the last link of its signer.

signed_since(First, pem(_, Last, _)) :-
    integer(Last),
    Last >= First.

%!  trail_signed(+Id, +Text:string, +Last, -Signed) is det.
%
%   Signed is the text to sign for a link with this Text in the trail of Id;
%   Last is the signature of the previous link, or `none`.

trail_signed(Id, Text, Last, Signed) :-
    format(string(All), '~w ~w ~w', [Id, Last, Text]),
    text_sum(All, Sum),
    atom_concat('typhon trail ', Sum, Signed).

typhon_words:enters(Module, Id, Result) :-
    trail_enter(Module, Id, Result).

%!  trail_enter(+Module, +Id, +Result) is det.
%
%   The agent Id, whose module is Module, enters Result, a mobile term.
%
%   @error existence_error(keys, here)

trail_enter(Module, Id, Result) :-
    (   own_keys(Keys)
    ->  raw(Module, Raw0),
        add_event(entered(Result), Keys, Id, Raw0, Raw),
        dynamic(Module:'$trail'/4),
        retractall(Module:'$trail'(_, _, _, _)),
        assertz(Module:Raw)
    ;   existence_error(keys, here)
    ).

%!  trail_of(+Module, +Id, -Raw) is det.
%
%   Raw is the trail for trail_verified/3 of the agent Id in Module.

trail_of(Module, Id, Raw) :-
    raw(Module, Raw0),
    (   own_keys(Keys)
    ->  sign_pending(Keys, Id, Raw0, Raw)
    ;   Raw = Raw0
    ).

raw(Module, Raw) :-
    Raw = '$trail'(_, _, _, _),
    (   '$c_current_predicate'(_, Module:Raw),
        clause(Module:Raw, true)
    ->  true
    ;   no_trail(Raw)
    ).

                /*******************************
                *     LINKS IN ONE STRING      *
                *******************************/

%   chain_add(+Link, +Chain0, +Most, -Chain) is semidet.
%
%   Chain is Count-Text.  Count0 includes Link; the oldest links are dropped
%   until there are at most Most.  Fails if the text has fewer links than that.

chain_add(link(Text, Hex, C), Count0-Chain0, Most, Count-Chain) :-
    format(string(Link), '~w ~d ~s', [Hex, C, Text]),
    string_length(Link, Length),
    format(string(Framed), '~`0t~d~8|~s', [Length, Link]),
    string_concat(Chain0, Framed, Chain1),
    newest(Count0, Most, Chain1, 0, Start, Count),
    sub_string(Chain1, Start, _, 0, Chain).

newest(Count, Most, _, Start, Start, Count) :-
    Count =< Most,
    !.
newest(Count0, Most, Chain, Start0, Start, Count) :-
    framed(Chain, Start0, _, Start1),
    Count1 is Count0-1,
    newest(Count1, Most, Chain, Start1, Start, Count).

%   framed(+Chain, +Start, -Link, -End): Link is the framed link at Start.

framed(Chain, Start, Link, End) :-
    sub_string(Chain, Start, 8, _, Digits),
    number_string(Length, Digits),
    integer(Length),
    Length >= 0,
    Begin is Start+8,
    sub_string(Chain, Begin, Length, _, Link),
    End is Begin+Length.

%!  chain_links(+Text, -Links:list) is semidet.
%
%   Links are ordered, the oldest first.  Text may be any term: a rest that has
%   no valid frame becomes a link without signature; fails if Text is no
%   string.

chain_links(Chain, Links) :-
    string(Chain),
    string_length(Chain, Length),
    links(0, Length, Chain, Links).

links(End, End, _, []) :-
    !.
links(Start, End, Chain, [Link|Links]) :-
    framed(Chain, Start, Framed, Next),
    link(Framed, Link),
    !,
    links(Next, End, Chain, Links).
links(Start, _, Chain, [link(Rest, "", none)]) :-
    sub_string(Chain, Start, _, 0, Rest).

link(Framed, link(Text, Hex, C)) :-
    until_space(Framed, Hex, Numbered),
    until_space(Numbered, Digits, Text),
    number_string(C, Digits).

until_space(Text, Before, After) :-
    sub_string(Text, Length, _, Rest, " "),
    !,
    sub_string(Text, 0, Length, _, Before),
    sub_string(Text, _, Rest, 0, After).
