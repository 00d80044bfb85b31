:- module(typhon_acceptor,
          [ accept_all/2,               % +Socket, +Me
            accept_no_more/0
          ]).

/** <module> Accepting connections

Each client has a thread of its own and, until it has proved itself, one of a
bounded number of slots. If all are taken, a new client gets the slot of
another, by these rules in this order: of an address from which no peer has
proved itself; of the address that holds most slots; of a client that has sent
nothing yet; of the oldest. So a client that only occupies slots keeps them only
as long as no other client needs them.

Most unknown clients speak another protocol. A client whose first byte has
arrived, and is not that of a greeting, gets neither slot nor thread.

A message for each second reports the number, addresses and reasons of refusals,
see typhon_reports.

*Threading*: accept_all/2 is the goal of a thread, which is woken by a
signal: closing the socket would not wake it. A mutex guards the slots: the
acceptor gives and takes them, the thread of a client reports its progress and
returns its own.
*/

:- autoload(library(aggregate), [aggregate_all/3]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/names', [counted/3]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_keys_values/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- autoload(library(socket), [tcp_accept/3]).
:- use_module('../base/reports', [report/4]).
:- use_module('../base/monotonic', [monotonic_time/1]).
:- use_module(connection, [incoming/5, open_streams/3]).
:- use_module(threads,
              [ manager_notify/1, wire_thread_create/4, wire_thread_running/1,
                wire_thread_signal/2 ]).
:- use_module(transport, [refusal_text/2, transport_first/2]).

:- setting(unproved, positive_integer, 128,
           "Connections at a time that have not proved themselves").

:- dynamic
    unproved/4,                         % Thread, Ip, Since, Stage
    proved/1.                           % Ip, of a peer; the newest last

%   The number of addresses kept in proved/1.

proved_addresses(256).

%!  accept_all(+Socket, +Me)
%
%   Serve all clients that connect to Socket until stopped by a signal.  Me is
%   the hello of this process.

accept_all(Socket, Me) :-
    repeat,
    catch(accept(Socket, Me), error(Formal, _), accept_failed(Formal)),
    fail.

%!  accept_no_more is det.
%
%   Close the streams of clients whose threads had not begun with them.  Called
%   when all threads of the endpoint have ended.

accept_no_more :-
    forall(unproved(Thread, _, _, _), take_slot(Thread)).

accept(Socket, Me) :-
    tcp_accept(Socket, Client, ip(A, B, C, D)),
    atomic_list_concat([A, B, C, D], '.', Ip),
    sig_atomic(admit(Client, Ip, Me)).

%   Most likely descriptors are used up: unproved clients may hold them.

accept_failed(Formal) :-
    refused(anywhere, Formal),
    sig_atomic(ignore(slot(evict(_)))),
    sleep(0.1).

admit(Client, Ip, Me) :-
    catch(open_streams(Client, In, Out),
          error(Formal, _),
          refused(Ip, Formal)),
    (   nonvar(In)
    ->  admit(In, Out, Ip, Me)
    ;   true
    ).

admit(In, Out, Ip, Me) :-
    catch(let_in(In, Out, Ip, Me, Evicted),
          error(Formal, _),
          ( close_streams(In, Out),
            refused(Ip, Formal) )),
    (   nonvar(Evicted)
    ->  refused(Evicted, silent)
    ;   true
    ).

let_in(In, Out, Ip, Me, Evicted) :-
    (   wait_for_input([In], [_], 0)
    ->  peek_code(In, Byte),
        check_first(Byte, Out)
    ;   true
    ),
    slot(give(In, Out, Ip, Me, Evicted)).

check_first(-1, _) :-
    !,
    syntax_error(end_of_file).
check_first(Byte, Out) :-
    transport_first(Byte, Out).

close_streams(In, Out) :-
    close(Out, [force(true)]),
    close(In, [force(true)]).

:- meta_predicate slot(0).

slot(Goal) :-
    with_mutex(typhon_acceptor, Goal).

give(In, Out, Ip, Me, Evicted) :-
    (   has_slot
    ->  true
    ;   evict(Evicted)
    ->  true
    ;   throw(error(crowd, _))
    ),
    monotonic_time(Now),
    wire_thread_create(serve(In, Out, Ip, Me), in-Ip, Thread,
                       assertz(unproved(Thread, Ip, Now, new(In, Out)))).

		 /*******************************
		 *            SLOTS             *
		 *******************************/

has_slot :-
    free_slot,
    !.
has_slot :-
    forall(( unproved(Thread, _, _, _), \+ wire_thread_running(Thread) ),
           bury(Thread)),
    free_slot.

free_slot :-
    predicate_property(unproved(_, _, _, _), number_of_clauses(Count)),
    setting(unproved, Max),
    Count < Max.

%   A thread that was interrupted in its first or last steps may not have
%   reported its end.

bury(Thread) :-
    take_slot(Thread),
    ignore(manager_notify(ended(Thread))).

evict(Ip) :-
    victim(Thread, Ip),
    take_slot(Thread),
    wire_thread_signal(Thread, evicted).

victim(Thread, Ip) :-
    findall(Ip0, unproved(_, Ip0, _, _), Ips0),
    msort(Ips0, Ips),
    pairs_keys_values(Pairs, Ips, Ips),
    group_pairs_by_key(Pairs, Holders),
    findall(Rank-(Thread1-Ip1),
            ( member(Ip1-Slots, Holders),
              address_rank(Ip1, Slots, Known, Free),
              unproved(Thread1, Ip1, Since, Stage),
              stage_rank(Stage, Spoke),
              Rank = rank(Known, Free, Spoke, Since) ),
            Ranked),
    keysort(Ranked, [_-(Thread-Ip)|_]).

%   The streams of a client whose thread has not begun with them are closed
%   here.

take_slot(Thread) :-
    retract(unproved(Thread, _, _, Stage)),
    !,
    (   Stage = new(In, Out)
    ->  close_streams(In, Out)
    ;   true
    ).

address_rank(Ip, Slots, Known, Free) :-
    (   proved(Ip)
    ->  Known = 1
    ;   Known = 0
    ),
    length(Slots, Count),
    Free is -Count.

%   A new client has had no time to send anything.

stage_rank(silent, Spoke) =>
    Spoke = 0.
stage_rank(_, Spoke) =>
    Spoke = 1.

		 /*******************************
		 *            CLIENTS           *
		 *******************************/

serve(In, Out, Ip, Me) :-
    call_cleanup(incoming(In, Out, Ip, typhon_acceptor:stage(Ip), Me),
                 leave).

%   stage(+Ip, +Stage): the client of this thread has come so far: `silent`, its
%   streams belong to its thread; `heard`; `proved`; or refused(Formal).  Fails
%   if the slot of the client was given to another, whose thread has counted the
%   refusal.

stage(Ip, refused(Formal)) :-
    !,
    sig_atomic(slot(returned)),
    refused(Ip, Formal).
stage(Ip, Stage) :-
    sig_atomic(slot(reach(Stage, Ip))).

returned :-
    thread_self(Me),
    retract(unproved(Me, _, _, _)),
    !.

reach(proved, Ip) :-
    !,
    leave,
    remember(Ip).
reach(Stage, _) :-
    thread_self(Me),
    retract(unproved(Me, Ip, Since, _)),
    !,
    assertz(unproved(Me, Ip, Since, Stage)).

leave :-
    thread_self(Me),
    retractall(unproved(Me, _, _, _)).

remember(Ip) :-
    proved(Ip),
    !.
remember(Ip) :-
    assertz(proved(Ip)),
    predicate_property(proved(_), number_of_clauses(Count)),
    proved_addresses(Max),
    (   Count > Max
    ->  once(retract(proved(_)))
    ;   true
    ).

		 /*******************************
		 *           REFUSALS           *
		 *******************************/

%   refused(+Ip, +Formal): a client at Ip was refused. Formal is that of an
%   error, `silent` (its slot was needed), `crowd` (there was no slot), or
%   version(V).

:- multifile typhon_reports:summary/3.

refused(Ip, Formal) :-
    reason(Formal, Why),
    level(Why, Level),
    report(Level, refused_clients, Ip-Why,
           typhon(endpoint, turned_away(Ip, Why))).

typhon_reports:summary(refused_clients, Groups,
                       typhon(endpoint, turned_away(Groups))).

%   reason(+Formal, -Why): Why has no details that differ from case to case.

reason(permission_error(authenticate, peer, Why0), Why) =>
    Why = Why0.
reason(syntax_error(end_of_file), Why) =>
    Why = hung_up.
reason(syntax_error(Why0), Why) =>
    Why = Why0.
reason(timeout_error(_, _), Why) =>
    Why = slow.
reason(io_error(_, _), Why) =>
    Why = broken.
reason(socket_error(_, _), Why) =>
    Why = broken.
reason(Why0, Why) =>
    Why = Why0.

level(Why, Level) :-
    (   memberchk(Why, [hung_up, broken])
    ->  Level = informational
    ;   Level = warning
    ).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, turned_away(Ip, Why))) -->
    [ 'Endpoint: refused a client at ~w: '-[Ip] ],
    why(Why).
prolog:message(typhon(endpoint, turned_away(Groups))) -->
    { aggregate_all(sum(Count), member(Count-_, Groups), Sum),
      counted(Sum, 'more client', Clients) },
    [ 'Endpoint: refused ~w:'-[Clients] ],
    groups(Groups).

groups([]) -->
    [].
groups([Count-Group|Groups]) -->
    { Group = Ip-Why -> true ; Ip-Why = others-several },
    [ nl, '  ~D at ~w: '-[Count, Ip] ],
    why(Why),
    groups(Groups).

why(version(Version)) -->
    !, [ 'it speaks another version of the protocol, ~w'-[Version] ].
why(Why) -->
    { ours(Why, Text) ; refusal_text(Why, Text) },
    !, [ '~w'-[Text] ].
why(Why) -->
    [ '~p'-[Why] ].

ours(cookie, 'its cookie is not that of this process').
ours(protocol, 'it uses another protocol').
ours(hung_up, 'it closed the connection').
ours(broken, 'the connection broke').
ours(slow, 'it did not complete the handshake in time').
ours(silent, 'its slot was given to another client').
ours(crowd, 'all slots are taken').
ours(line, 'it sent a line that is too long').
ours(other, 'it claims to be another process').
ours(several, 'for several reasons').
