:- use_module(common).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module(hogs).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/cell), [cells_list/1]).
:- use_module(library(lists), [last/2, member/2, nth1/3, sum_list/2]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

/*  The cost of cells: memory and start of a cell; a turn in a cell, both
ways, and a message from it; hops of an agent between another process and a
host with cells, compared with a guarded host without cells, and with an
unguarded host.  And the speed of agents that hop between a host without cells
in the same process and another process, while hogs arrive at the host with
cells, one after the other.  And what a busy agent in a cell gets beside busy
processes, in sessions of their own.

A figure is the median of the ratios of pairs that are measured one after the
other, every second pair in the other order, because the load of the machine
changes from one minute to the next. */

:- initialization(main, main).

main([Placement]) :-
    host_start(here),
    with_peer([env], costs),
    shares,
    with_peer([env], beside_all_hogs(Placement)),
    host_stop(here).

                /*******************************
                *             SHARES           *
                *******************************/

%   The share that a busy agent in a cell has of what a busy process has, and
%   of one processor while these processes run.

shares :-
    with_inn(owner, 600,
             ( agent_create(clauses([ (:- agent(busy, [])),
                                      (main :- repeat, fail) ]),
                            A, [host(inn)]),
               once(( repeat, busy_cell(Pid) )),
               forall(member(Count, [2,4,8]), share(Count, Pid)),
               agent_dispose(A, [force(0)]) )).

share(Count, Pid) :-
    setup_call_cleanup(
        findall(Hog, ( between(1, Count, _), busy_process(Hog) ), Hogs),
        ( used(Pid, Own0),
          used_by(Hogs, All0),
          get_time(Start),
          sleep(10),
          used(Pid, Own),
          used_by(Hogs, All),
          get_time(End) ),
        forall(member(Hog, Hogs),
               ( process_kill(Hog, kill), process_wait(Hog, _) ))),
    Of is (Own-Own0)/(End-Start),
    Ratio is (Own-Own0)*Count/(All-All0),
    format(atom(Name), 'a busy agent in a cell beside ~d busy processes',
           [Count]),
    format(atom(Note), '~3g of what one of them gets', [Ratio]),
    figure(Name, Of, processors, Note).

%   The process below bwrap that uses the processor.

busy_cell(Child) :-
    cells_list(Cells),
    member(cell(_, Pid, Key), Cells),
    Key \== spare,
    format(atom(Children), '/proc/~w/task/~w/children', [Pid, Pid]),
    read_file_to_string(Children, Text, []),
    split_string(Text, " ", " ", [First|_]),
    number_string(Child, First),
    used(Child, Seconds),
    Seconds > 0.5.

busy_process(Pid) :-
    process_create(path(setsid), [sh, '-c', 'while :; do :; done'],
                   [process(Pid)]).

used_by(Pids, Seconds) :-
    findall(S, ( member(Pid, Pids), used(Pid, S) ), Each),
    sum_list(Each, Seconds).

%   In hundredths, on all usual systems.

used(Pid, Seconds) :-
    format(atom(File), '/proc/~d/stat', [Pid]),
    read_file_to_string(File, Text, []),
    split_string(Text, ")", "", Parts),
    last(Parts, Rest),
    split_string(Rest, " ", " ", Words),
    nth1(12, Words, User),
    nth1(13, Words, System),
    number_string(U, User),
    number_string(S, System),
    Seconds is (U+S)/100.

                /*******************************
                *             COSTS            *
                *******************************/

costs(Peer) :-
    with_inn(owner, inside),
    travelled(1, 2000, Peer, _),        % warm up
    findall(Us, ( between(1, 5, Round), trips(Round, Peer, Us) ), All),
    pairs(All, 'a turn in a cell, there and back', turn, plain, us,
          'a plain hop'),
    pairs(All, 'a hop to or from a host with cells', cell, plain, us,
          'a plain hop'),
    pairs(All, 'the same', cell, guarded, us, 'a hop where the host guards'),
    pairs(All, 'a message from a cell', message, here, us,
          'one from a host that guards').

inside :-
    seconds(done([main]), First),
    figure('the first agent of an owner, a cell being ready', First*1000, ms),
    cells_list(Cells),
    once(( member(cell(_, Pid, Key), Cells), Key \== spare )),
    private_bytes(Pid, Bytes),
    figure('private memory of an idle cell', Bytes/1 000 000, 'MB').

%   Bytes of bwrap, and of the process that it has started.

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

trips(Round, Peer, [plain-Plain,guarded-Guarded,here-Here,cell-Cell,turn-Turn,
                    message-Message]) :-
    in_turns(Round,
             ( hop_us(here, Peer, Plain),
               with_inn(none, ( hop_us(inn, Peer, Guarded),
                                message_us(Here) )) ),
             with_inn(owner, ( done([main]), hop_us(inn, Peer, Cell),
                               turn_us(Turn), message_us(Message) ))).

in_turns(Round, A, B) :-
    (   Round mod 2 =:= 1
    ->  once(A), once(B)
    ;   once(B), once(A)
    ).

%   pairs(+Rounds, +Name, +A, +B, +Unit, +What): a round is a list of
%   Name-Value.

pairs(Rounds, Name, A, B, Unit, What) :-
    findall(VA-VB, ( member(Round, Rounds), memberchk(A-VA, Round),
                     memberchk(B-VB, Round) ), Pairs),
    findall(R, ( member(VA-VB, Pairs), R is VA/VB ), Ratios),
    findall(VA, member(VA-_, Pairs), As),
    findall(VB, member(_-VB, Pairs), Bs),
    median(Ratios, Ratio),
    median(As, MedianA),
    median(Bs, MedianB),
    format(atom(Note), '~3g ~w against ~3g (~w)',
           [MedianA, Unit, MedianB, What]),
    figure(Name, Ratio, times, Note).

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

%   Below the quota of messages per second.

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

                /*******************************
                *             HOGS             *
                *******************************/

beside_all_hogs(Placement, Peer) :-
    with_inn(owner, 0.3,
             forall(hog(What, Clauses),
                    beside_hog(What, Clauses, Peer, Placement))).

beside_hog(What, Clauses, Peer, Placement) :-
    findall([alone-Alone,beside-Beside],
            ( between(1, 5, Round),
              in_turns(Round,
                       travelled(10, 20 000, Peer, rates(Alone, _)),
                       beside_hogs(inn, Clauses,
                                   travelled(10, 20 000, Peer,
                                             rates(Beside, _)))) ),
            Rounds),
    atomic_list_concat(['hops of ten agents beside a hog in a cell, of ', What,
                        ', ', Placement], Name),
    pairs(Rounds, Name, beside, alone, '1/s', alone).

hog(nothing, [ main ]).
hog('a large number', [ (main :- between(1, inf, _),
                                 _ is (7**10000000) mod 11, fail) ]).
hog(What, Clauses) :-
    hog_clauses(What, Clauses).

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(typhon(over_limit(_, _)), _, _).
user:message_hook(typhon(cell_ended(_, _, _, _)), _, _).
