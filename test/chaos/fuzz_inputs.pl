:- module(fuzz_inputs,
          [ client_input/1,             % -Input
            peer_frames/2               % +Codec, -Frames
          ]).

/** <module> Malformed and hostile input

All inputs are drawn from the random generator of the thread, so that a seed
determines an input.

*Threading*: no state.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists),
              [append/2, append/3, member/2, nth0/4, nth1/4, numlist/3]).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(yall), [(>>)/3]).
:- use_module(library(typhon/kernel/wire/frame), [check_bytes/2, term_bytes/3]).
:- use_module(library(typhon/kernel/wire/handshake), [hello/4, hello_line/2]).

		 /*******************************
		 *         STRANGERS            *
		 *******************************/

%!  client_input(-Input) is det.
%
%   Input is send(Codes, End), the input of a client without the cookie, where
%   End is `close`, `linger` or `drip`.

client_input(send(Codes, End)) :-
    random_between(1, 12, Kind),
    said(Kind, Codes),
    random_between(1, 60, N),
    ending(N, End).

ending(1, linger) :- !.
ending(2, drip) :- !.
ending(_, close).

said(1, []).
said(2, Codes) :-
    random_between(1, 600, Length),
    random_codes(Length, Codes).
said(3, Codes) :-
    random_member(Text, [`GET / HTTP/1.1\r\nHost: x\r\n\r\n`,
                         `POST /x HTTP/1.0\r\nContent-Length: 9999999\r\n\r\n`,
                         `SSH-2.0-OpenSSH_9.2\r\n`, `halt.\n`, `\n`,
                         `typhon\n`, `typhon 3\n`, `typhon 3 \n`,
                         `typhon 1 00 a 1 b:1 90004 64 little\n`,
                         `typhon 99999999999999999999 x\n`,
                         `typhon 3 00 a 1 b:1 90004 64 little\n\n\n\n`]),
    Codes = Text.
said(4, [0x16, 3, 1, L1, L0|Codes]) :-  % how TLS begins
    random_between(0, 255, L1),
    random_between(0, 255, L0),
    random_codes(200, Codes).
said(5, [255, 255, 255, 255|Codes]) :-
    random_codes(20, Codes).
said(6, Codes) :-
    random_between(500, 20000, Length),
    length(Codes, Length),
    random_between(0, 255, Code),
    maplist(=(Code), Codes).
said(7, Codes) :-                       % a frame, where a line should be
    term_bytes(fast, request(1, remote, remote(victim, halt)), Bytes),
    framed(Bytes, Codes).
said(8, Codes) :-
    greeting(Codes).
said(9, Codes) :-
    greeting(Greeting),
    cut(Greeting, Codes).
said(10, Codes) :-
    greeting(Greeting),
    flipped(Greeting, Codes).
said(11, Codes) :-                      % a proof by guessing
    greeting(Greeting),
    length(Proof, 64),
    maplist([C]>>random_member(C, `0123456789abcdef`), Proof),
    append([Greeting, Proof, `\nresume 0\n`], Codes).
said(12, Codes) :-
    greeting(Greeting),
    random_codes(200, Garbage),
    append(Greeting, Garbage, Codes).

greeting(Codes) :-
    random_word(Process),
    hello(Process, 1, '127.0.0.1:1', Hello),
    random_between(1, 7, At),
    (   At =< 6
    ->  random_word(Word),
        setarg(At, Hello, Word)
    ;   true
    ),
    catch(hello_line(Hello, Line), error(_, _), Line = "a b c"),
    random_word(Nonce),
    format(codes(Codes), "typhon 3 ~w ~w\n", [Nonce, Line]).

random_word(Word) :-
    random_member(Word, [x, 17, -1, 0, '', 'a b', '127.0.0.1:99999',
                         ':', 'x:y', 99999999999999999999999, 1.0Inf,
                         '\u00e9', little, none]).

		 /*******************************
		 *             PEERS            *
		 *******************************/

%!  peer_frames(+Codec, -Frames) is det.
%
%   Frames are lists of codes, the frames of a faulty peer that has the
%   cookie. No record with a valid checksum is damaged.

peer_frames(Codec, Frames) :-
    random_between(1, 8, Count),
    length(Frames, Count),
    maplist(peer_frame(Codec), Frames).

peer_frame(Codec, Codes) :-
    random_between(1, 10, Kind),
    peer_frame(Kind, Codec, Codes).

peer_frame(1, Codec, Codes) :-          % damaged on its way
    !,
    right_frame(Codec, Frame),
    flipped(Frame, Codes).
peer_frame(2, Codec, Codes) :-
    !,
    right_frame(Codec, Frame),
    cut(Frame, Codes).
peer_frame(3, _, [B3, B2, B1, B0, 0,0,0, 0,0,0,0, 0,0,0,0, 1, 2, 3]) :-
    !,
    maplist([B]>>random_between(0, 255, B), [B3, B2, B1, B0]).
peer_frame(4, text, Codes) :-           % damaged by its sender
    !,
    random_frame(Term),
    term_bytes(text, Term, Bytes0),
    string_codes(Bytes0, [Mark|Codes0]),
    flipped(Codes0, Codes1),
    string_codes(Bytes, [Mark|Codes1]),
    framed(Bytes, Codes).
peer_frame(_, Codec, Codes) :-
    right_frame(Codec, Codes).

right_frame(Codec, Codes) :-
    random_frame(Term),
    term_bytes(Codec, Term, Bytes),
    framed(Bytes, Codes).

framed(Bytes, [B3, B2, B1, B0, C2, C1, C0, 0,0,0,R, 0,0,0,S|Codes]) :-
    string_codes(Bytes, Codes),
    string_length(Bytes, Length),
    random_member(R, [0, 0, 0, 1, 100]),
    random_member(S, [0, 0, 0, 1, 100]),
    check_bytes(Bytes, Hash),
    Check is (Hash + 7919*R + 104729*S) /\ 0xffffff,
    B3 is Length>>24,
    B2 is (Length>>16) /\ 255,
    B1 is (Length>>8) /\ 255,
    B0 is Length /\ 255,
    C2 is Check>>16,
    C1 is (Check>>8) /\ 255,
    C0 is Check /\ 255.

random_frame(Term) :-
    findall(T, frame(T), Terms),
    random_member(Term0, Terms),
    random_between(0, 2, Times),
    mutated(Times, Term0, Term).

frame(objection(1, spoilt)).
frame(objection(0, deferred)).
frame(hand(hop, x)).
frame(Term) :-
    requested(hop, Body),
    Term = hand(hop, Body).
frame(ping).
frame(answer(0, x)).
frame(spoilt(1)).
frame(unreadable(x, request(1))).
frame(zork).
frame(Term) :-
    posted(Kind, Body),
    Term = post(Kind, Body).
frame(Term) :-
    requested(Kind, Body),
    Term = request(7, Kind, Body).

agent('fuzz.00000000.1@fuzz@127.0.0.1:1').

posted(message, message(Agent, [Agent-hello], 10)) :-
    agent(Agent).
posted(message, shown([birth(Agent, hash, pem, "00")],
                      message(Agent, [mail('127.0.0.1:1', Agent, hello)], 10))) :-
    agent(Agent).
posted(message, abroad(fipa(x), Agent, hello)) :-
    agent(Agent).
posted(whereabouts, shown([birth(Agent, hash, pem, "00")],
                          [ended(Agent, done, 4)])) :-
    agent(Agent).
posted(whereabouts, located(Agent, 'fuzz@127.0.0.1:1', 3)) :-
    agent(Agent).
posted(whereabouts, ended(Agent, done, 4)) :-
    agent(Agent).
posted(pheromone, pheromone(victim, withdrawn(source, problem))).
posted(pheromone,
       pheromone(victim, smelt('fuzz@127.0.0.1:1',
                               signal(p, source, 1.0, 1, 1.0, 0.0, 1)))).
posted(log, event('log@127.0.0.1:1', host, Agent, what)) :-
    agent(Agent).
posted(zork, zork).

requested(hop, hop(victim,
                   image(Agent, hash, life(none, 1, inf, [], [], false, []),
                         state([], [f(1)-true]), [true], [], 0.0),
                   Program)) :-
    agent(Agent),
    member(Program, [ known, zork, program(zork, [], []),
                      papers(birth(Agent, hash, pem, "00"), known) ]).
requested(whereabouts, reached(Agent, 2)) :-
    agent(Agent).
requested(agent, question(Agent, properties)) :-
    agent(Agent).
requested(agent, question(Agent, order(dispose))) :-
    agent(Agent).
requested(agent, create(victim, zork, start(hash, [], [], [], []), zork)).
requested(join, join(Agent, 0.1)) :-
    agent(Agent).
requested(hosting, host_properties(victim)).
requested(hosting, link(nowhere, 'fuzz@127.0.0.1:1')).
requested(hosting, unlink(nowhere, 'fuzz@127.0.0.1:1')).
requested(remote, remote(victim, true)).
requested(remote, remote(victim, zork(1))).
requested(log, arrived).
requested(node, zork).
requested(zork, zork).

		 /*******************************
		 *           CHANGES            *
		 *******************************/

mutated(0, Term, Term) :-
    !.
mutated(Times, Term0, Term) :-
    mutated(Term0, Term1),
    Times1 is Times-1,
    mutated(Times1, Term1, Term).

%   Some subterm becomes something else.

mutated(Term0, Term) :-
    compound(Term0),
    compound_name_arguments(Term0, Name, Args0),
    Args0 \== [],
    random_between(1, 5, Choice),
    Choice > 1,
    !,
    length(Args0, Arity),
    random_between(1, Arity, At),
    nth1(At, Args0, Old, Rest),
    mutated(Old, New),
    nth1(At, Args, New, Rest),
    compound_name_arguments(Term, Name, Args).
mutated(_, Term) :-
    random_between(1, 12, Kind),
    junk(Kind, Term).

junk(1, _).
junk(2, []).
junk(3, zork).
junk(4, "text").
junk(5, -1).
junk(6, 123456789012345678901234567890).
junk(7, 1.5NaN).
junk(8, zork(_, [a|_])).
junk(9, Long) :-
    numlist(1, 2000, Long).
junk(10, '').
junk(11, f(X, X, "\x0\", '\u00e9\u4e00')).
junk(12, Atom) :-
    length(Codes, 5000),
    maplist(=(0'a), Codes),
    atom_codes(Atom, Codes).

random_codes(Length, Codes) :-
    length(Codes, Length),
    maplist([C]>>random_between(0, 255, C), Codes).

cut(Codes0, Codes) :-
    length(Codes0, Length),
    random_between(0, Length, Left),
    length(Codes, Left),
    append(Codes, _, Codes0).

flipped(Codes0, Codes) :-
    random_between(1, 3, Times),
    flipped(Times, Codes0, Codes).

flipped(0, Codes, Codes) :-
    !.
flipped(Times, Codes0, Codes) :-
    length(Codes0, Length),
    Last is Length-1,
    random_between(0, Last, At),
    random_between(0, 7, Bit),
    nth0(At, Codes0, Code0, Rest),
    Code is Code0 xor (1<<Bit),
    nth0(At, Codes1, Code, Rest),
    Times1 is Times-1,
    flipped(Times1, Codes1, Codes).
