:- module(test_attacker, []).

/** <module> A process that accepts agents and sends forged ones

    swipl test/lib/attacker.pl DIRECTORY

It speaks the wire protocol, with the keys in DIRECTORY, and does not run
agents: the image of an agent is a term that it keeps, alters and sends.  It
prints its address, and reads commands:

  - had: prints had(Count), the number of images received
  - send(Endpoint, Host, N, Change): sends the image that came as the N-th to
    Host, and prints the answer.  Change is `none`; `next`, with one hop more;
    or unlinked(I), with one hop more and without the I-th link of its trail

Any other command ends it.

*Threading*: the main thread reads; images come in the reader threads of the
endpoint.
*/

:- use_module(common).
:- use_module(library(lists), [nth1/3, nth1/4, select/4]).
:- use_module(library(main), [main/0]).
:- use_module(library(typhon/kernel/wire)).
:- use_module(library(typhon/options/tls), []).

:- initialization(main, main).

:- public main/1.

:- dynamic had/2.                       % Image, Papers

:- multifile
    typhon_endpoint:handed/4,
    typhon_endpoint:requested/4.

typhon_endpoint:requested(hop, Request, _, ReplyTo) :-
    Request =.. [hop, _, Image, Papers|_],
    assertz(had(Image, Papers)),
    endpoint_reply(ReplyTo, accepted).
typhon_endpoint:handed(hop, hop(_, Image0, Papers), _, accepted) :-
    Image0 = image(Id, Hash, Life, State, true-Goals, Mail, Since),
    Image = image(Id, Hash, Life, State, Goals, Mail, Since),
    assertz(had(Image, Papers)).

main([Keys]) :-
    endpoint_start(localhost, 0, [tls(Keys)], Address),
    say(Address),
    repeat,
    read_term(user_input, Command, []),
    (   command(Command)
    ->  fail
    ;   !,
        endpoint_stop
    ).

say(Term) :-
    format("~q.~n", [Term]),
    flush_output.

command(had) :-
    findall(x, had(_, _), All),
    length(All, Count),
    say(had(Count)).
command(send(Endpoint, Host, N, Change)) :-
    findall(Image-Papers, had(Image, Papers), All),
    nth1(N, All, Image0-Sent),
    changed(Change, Image0, Image),
    endpoint_call(Endpoint, hop, hop(Host, Image, Sent), Answer, 20),
    say(Answer).

changed(none, Image, Image).
changed(next, image(Id, Hash, Life0, State, Goals, Mail, Since),
        image(Id, Hash, Life, State, Goals, Mail, Since)) :-
    Life0 =.. [life, Parent, Hops0|More],
    Hops is Hops0+1,
    Life =.. [life, Parent, Hops|More].
changed(unlinked(I), Image0, image(Id, Hash, Life, State, Goals, Mail, Since)) :-
    changed(next, Image0, image(Id, Hash, Life, State0, Goals, Mail, Since)),
    State0 = state(Empty, Clauses0),
    Old = '$trail'(at(Next, Made, Kept0, Last, Handed), Chain0, Pems, Pending),
    New = '$trail'(at(Next, Made, Kept, Last, Handed), Chain, Pems, Pending),
    select(Old, Clauses0, New, Clauses),
    State = state(Empty, Clauses),
    Kept is Kept0-1,
    framed(Chain0, Links0),
    nth1(I, Links0, _, Links),
    atomics_to_string(Links, Chain).

%   framed(+Chain, -Links): each with its length before it.

framed("", []) :-
    !.
framed(Chain, [Link|Links]) :-
    sub_string(Chain, 0, 8, _, Digits),
    number_string(Length, Digits),
    All is Length+8,
    sub_string(Chain, 0, All, _, Link),
    sub_string(Chain, All, _, 0, Rest),
    framed(Rest, Links).

atomics_to_string(Strings, String) :-
    atomic_list_concat(Strings, Atom),
    atom_string(Atom, String).
