:- use_module(common).
:- use_module(hogs).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/cell/cells), [cells_list/1]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

/*  What cells cost: memory and start of one; a turn in a cell, there and back,
and a message from there; hops of an agent between another process and a host with
cells, against the same where the host guards without, and where it does not
guard.  And what is left of the speed of agents that hop between a host of the same
process, which has no cells, and another process, while hogs come to the host
with cells, one after the other. */

:- initialization(main, main).

main([Placement]) :-
    host_start(here),
    with_peer([env], costs),
    with_peer([env], beside_all_hogs(Placement)),
    host_stop(here).

                /*******************************
                *             COSTS            *
                *******************************/

costs(Peer) :-
    with_inn(owner, inside),
    travelled(1, 2000, Peer, _),        % warm up
    findall(Rates, ( between(1, 3, _), trips(Peer, Rates) ), All),
    mean(1, All, Plain), mean(2, All, Guarded), mean(3, All, Cell),
    mean(4, All, Turn), mean(5, All, Message), mean(6, All, Here),
    ratio('a turn in a cell, there and back', Turn, Plain, us, 'a plain hop'),
    ratio('a hop to or from a host with cells', Cell, Plain, us,
          'a plain hop'),
    ratio('the same', Cell, Guarded, us, 'a hop where the host guards'),
    ratio('a message from a cell', Message, Here, us,
          'one from a host that guards').

inside :-
    seconds(done([main]), First),
    figure('the first agent of an owner, a cell being ready', First*1000, ms),
    cells_list(Cells),
    once(( member(cell(_, Pid, Key), Cells), Key \== spare )),
    private_bytes(Pid, Bytes),
    figure('private memory of an idle cell', Bytes/1 000 000, 'MB').

%   That of bwrap, and of the process that it has started.

private_bytes(Pid, Bytes) :-
    format(atom(File), '/proc/~w/task/~w/children', [Pid, Pid]),
    read_file_to_string(File, Text, []),
    split_string(Text, " ", " ", Children),
    findall(B,
            ( ( P = Pid ; member(P, Children), P \== "" ),
              private_of(P, B) ),
            Each),
    sum_list(Each, Bytes).

private_of(Pid, Bytes) :-
    format(atom(File), '/proc/~w/smaps_rollup', [Pid]),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "", Lines),
    findall(KB, ( member(Line, Lines),
                  sub_string(Line, 0, _, _, "Private_"),
                  split_string(Line, " ", " ", Words),
                  member(Word, Words), number_string(KB, Word) ), KBs),
    sum_list(KBs, Sum),
    Bytes is 1024*Sum.

trips(Peer, us(Plain, Guarded, Cell, Turn, Message, Here)) :-
    hop_us(here, Peer, Plain),
    with_inn(none, ( hop_us(inn, Peer, Guarded), message_us(Here) )),
    with_inn(owner, ( done([main]), hop_us(inn, Peer, Cell), turn_us(Turn),
                      message_us(Message) )).

with_inn(Kind, Goal) :-
    with_inn(Kind, 5, Goal).

with_inn(Kind, Seconds, Goal) :-
    setup_call_cleanup(
        host_start(inn, [ policy(guarded), cell(Kind),
                          quota([seconds(Seconds)]) ]),
        once(Goal),
        host_stop(inn)).

hop_us(Host, Peer, Us) :-
    traveller(Program),
    Rounds = 500,
    seconds(( agent_create(Program, A, [ host(Host),
                                         facts([left(Rounds), peer(Peer)]) ]),
              agent_join(A, done, 300) ), Seconds),
    Us is Seconds/(2*Rounds)*1.0e6.

turn_us(Us) :-
    Turns = 1000,
    seconds(done([ (main :- loop(Turns)), loop(0),
                   (loop(N) :- N > 0, sleep(0), N1 is N-1, loop(N1)) ]),
            Seconds),
    Us is Seconds/Turns*1.0e6.

%   Within the quota of messages in a second.

message_us(Us) :-
    Messages = 2000,
    agent_create(clauses([(:- agent(sink, [])), on_message(_, _)]), Sink,
                 [host(here)]),
    seconds(done([ (main :- forall(between(1, Messages, N), send(Sink, N))) ]),
            Seconds),
    agent_dispose(Sink),
    Us is Seconds/Messages*1.0e6.

done(Clauses) :-
    agent_create(clauses([(:- agent(one, []))|Clauses]), A, [host(inn)]),
    agent_join(A, done, 300).

mean(I, All, Mean) :-
    findall(X, ( member(Us, All), arg(I, Us, X) ), Xs),
    sum_list(Xs, Sum),
    length(Xs, Count),
    Mean is Sum/Count.

                /*******************************
                *             HOGS             *
                *******************************/

beside_all_hogs(Placement, Peer) :-
    with_inn(owner, 0.3,
             forall(hog(What, Clauses),
                    beside_hog(What, Clauses, Peer, Placement))).

beside_hog(What, Clauses, Peer, Placement) :-
    findall(Alone-Beside,
            ( between(1, 3, _), rates(Clauses, Peer, Alone, Beside) ),
            Pairs),
    findall(A, member(A-_, Pairs), As), sum_list(As, Alone3),
    findall(B, member(_-B, Pairs), Bs), sum_list(Bs, Beside3),
    Alone1 is Alone3/3,
    Beside1 is Beside3/3,
    atomic_list_concat(['hops of ten agents beside a hog in a cell, of ', What,
                        ', ', Placement], Name),
    ratio(Name, Beside1, Alone1, '1/s', 'alone').

rates(Clauses, Peer, Alone, Beside) :-
    travelled(10, 4000, Peer, rates(Alone, _)),
    beside_hogs(inn, Clauses, travelled(10, 4000, Peer, rates(Beside, _))).

hog(nothing, [ main ]).
hog('a large number', [ (main :- between(1, inf, _),
                                 _ is (7**10000000) mod 11, fail) ]).
hog(What, Clauses) :-
    hog_clauses(What, Clauses).

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(typhon(over_limit(_, _)), _, _).
user:message_hook(typhon(cell_lost(_, _, _)), _, _).
