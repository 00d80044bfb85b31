:- module(typhon_fleet_journal, []).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/durable', [crash_point/1]).
:- use_module('../../kernel/base/monotonic',
              [deadline/2, monotonic_time/1, poll_within/2]).
:- use_module('../../kernel/base/server',
              [server_answer/2, server_call/4, server_start/4, server_stop/1]).
:- use_module(engine, [engine/3, engine_key/3, engine_script/4]).
:- use_module(members, [fleet_joined/2, fleet_member/3, must_be_fleet/1]).

/** <module> A journal in the engine of a fleet: journal(redis('lab/alpha'))

A back end of typhon_store, with the Base redis(Fleet, Name).  The items are the
fields of one hash; a commit is one script.  The script first compares the owner
of the journal.  So a process that was suspended, and whose journal another
process has opened meanwhile, commits nothing more, and as output leaves a
process only after its commit, it sends nothing.

This process keeps a copy of the items, as they are after the last commit.  Each
commit has a number, and states that of the last one that was answered.  An
engine that does not know it has lost commits, or all: then the process writes
its copy, in parts, which become the journal at the end, in one step.  Of two
processes that do so the one that has opened the journal later is right; an
empty engine waits one lease for it.

Keys, for each Name:

  | i:Name        | hash   | `Kind N Key` -> sum, bytes; `about`: the format |
  | j:Name:owner  | string | number and token of the process that has it     |
  | j:Name:lease  | string | lapses unless the owner renews it               |
  | j:Name:number | number | of the last commit                              |
  | j:Name:parts  | hash   | items of a commit, or copy, that is incomplete  |
  | j:Name:record | string | of the network                                  |

*Threading*: one thread at a time.  After the start a thread of the journal
makes all calls, as a commit must not wait with a deadline inside sig_atomic/1.
*/

:- multifile
    prolog:error_message//1,
    prolog:message//1,
    typhon_members:journal/3,
    typhon_store:backend_place/4,
    typhon_store:backend_part/4,
    typhon_store:backend_found/2,
    typhon_store:backend_open/4,
    typhon_store:backend_close/1,
    typhon_store:backend_commit/3,
    typhon_store:backend_item/7,
    typhon_store:backend_record/3,
    typhon_store:backend_record_put/3,
    typhon_store:backend_record_drop/2.

:- dynamic
    owned/3,                    % Journal, Ttl, Server
    settles/1,                  % Stamp: no commit before it
    numbers/2,                  % Last, Next: of commits
    item/4,                     % Kind, Key, N, Value: the copy
    unsent/3.                   % Kind, Key, N: changed since the last commit

                /*******************************
                *             PLACES           *
                *******************************/

typhon_store:backend_place(redis, redis(Path), Place, redis(Fleet, Name)) :-
    (   atom(Path),
        sub_atom(Path, Before, 1, After, /),
        sub_atom(Path, 0, Before, _, Fleet),
        sub_atom(Path, _, After, 0, Name),
        Fleet \== '',
        Name \== ''
    ->  atom_concat('redis:', Path, Place)
    ;   domain_error(fleet_journal, Path)
    ).

typhon_store:backend_part(redis, redis(Path), P, redis(Part)) :-
    atomic_list_concat([Path, '.process', P], Part).

typhon_store:backend_found(redis(Fleet, Name), Place) :-
    items_key(Fleet, Name, Key),
    asked(Fleet, Place, exists(Key), 1).

typhon_store:backend_record(redis(Fleet, Name), Place, Text) :-
    record_key(Fleet, Name, Key),
    asked(Fleet, Place, get(Key), Text).
typhon_store:backend_record_put(redis(Fleet, Name), Place, Text) :-
    record_key(Fleet, Name, Key),
    asked(Fleet, Place, set(Key, Text), _).
typhon_store:backend_record_drop(redis(Fleet, Name), Place) :-
    record_key(Fleet, Name, Key),
    asked(Fleet, Place, del(Key), _).

record_key(Fleet, Name, Key) :-
    engine_key(Fleet, [j, Name, record], Key).

items_key(Fleet, Name, Key) :-
    engine_key(Fleet, [i, Name], Key).

asked(Fleet, Place, Command, Answer) :-
    must_be_fleet(Fleet),
    in_terms_of(Place, engine(Fleet, Command, Answer0)),
    Answer = Answer0.

:- meta_predicate in_terms_of(+, 0).

%   in_terms_of(+Place, :Goal): call Goal; turn errors of the engine into errors
%   of the journal at Place.

in_terms_of(Place, Goal) :-
    catch(Goal, error(Formal, Context), true),
    (   nonvar(Formal)
    ->  throw_meaning(Formal, Context, Place)
    ;   true
    ).

throw_meaning(resource_error(fleet(_)), Context, Place) :-
    !,
    ( nonvar(Context), Context = context(_, Why) -> true ; true ),
    throw(error(journal_unreachable(Place, Why), _)).
throw_meaning(existence_error(fleet, _), _, Place) :-
    !,
    throw(error(journal_unreachable(Place, 'this process has left the fleet'),
                _)).
throw_meaning(resource_error(fleet_space(_)), Context, _) :-
    !,
    throw(error(resource_error(journal_space), Context)).
throw_meaning(Formal, Context, _) :-
    throw(error(Formal, Context)).

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%   A process that has died keeps its lease for a while.

typhon_store:backend_open(redis(Fleet, Name), Place, Sync, Seconds) :-
    must_be_fleet(Fleet),
    about(About),
    lease(Fleet, Lease, Ttl),
    Token is random(1<<60),
    Most is max(Seconds, Lease+1),
    in_terms_of(Place, opened(Most, Fleet, [Name,Token,Ttl,About], Answer)),
    must_be_open(Answer, Place, Owner, Number, Taken),
    Journal = journal(Fleet, Name, Owner, Place),
    catch(in_terms_of(Place, begins(Journal, Ttl, Number, Taken)),
          error(Formal, Context),
          ( ends(Journal), throw(error(Formal, Context)) )),
    warn_of_loss(Sync, Fleet, Place).

lease(Fleet, Lease, Ttl) :-
    fleet_joined(Fleet, Options),
    option(lease(Lease), Options, 3),
    Ttl is integer(1000*Lease).

about(About) :-
    typhon_item_format:format_current(Version, Sample),
    atomic_list_concat([Version, Sample], ' ', About).

opened(Seconds, Fleet, Args, Answer) :-
    (   poll_within(Seconds,
                    ( engine_script(Fleet, journal_open, Args, Answer0),
                      Answer0 \= ["busy"] ))
    ->  Answer = Answer0
    ;   Answer = ["busy"]
    ).

must_be_open(["ok", Owner, Number0, Taken], _, Owner, Number, Taken) :-
    number_string(Number, Number0).
must_be_open(["busy"], Place, _, _, _) :-
    not_opened(Place, 'another process has it').
must_be_open(["lost"], Place, _, _, _) :-
    throw(error(journal_damaged(Place, 'the engine has lost it'), _)).
must_be_open(["other", About], Place, _, _, _) :-
    split_string(About, " ", "", [Version0|_]),
    number_string(Version, Version0),
    throw(error(journal_version(Place, Version), _)).

not_opened(Place, Why) :-
    throw(error(permission_error(open, journal, Place), context(_, Why))).

begins(Journal, Ttl, Number, Taken) :-
    Journal = journal(Fleet, Name, _, _),
    Next is Number+1,
    assertz(numbers(Number, Next)),
    items_key(Fleet, Name, Key),
    read_items(Fleet, Key, 0),
    settle(Taken, Fleet),
    server_start(fleet_journal, typhon_fleet_journal:handle(Journal, Ttl),
                 none, Server),
    assertz(owned(Journal, Ttl, Server)).

read_items(Fleet, Key, Cursor) :-
    engine(Fleet, hscan(Key, Cursor, count, 1000), [Next, Fields]),
    read_fields(Fields),
    (   Next == "0"
    ->  true
    ;   read_items(Fleet, Key, Next)
    ).

read_fields([]).
read_fields([Field, Value|Fields]) :-
    (   field(Kind, Key, N, Field)
    ->  set_item(Kind, Key, N, Value)   % a scan may show it twice
    ;   true
    ),
    read_fields(Fields).

%   field(?Kind, ?Key, ?N, ?Field)

field(Kind, Key, N, Field) :-
    atom(Kind),
    !,
    atomic_list_concat([Kind, N, Key], ' ', Field).
field(Kind, Key, N, Field) :-
    sub_string(Field, B, 1, A, " "),
    !,
    sub_string(Field, 0, B, _, Kind0),
    sub_string(Field, _, A, 0, Rest),
    sub_string(Rest, B1, 1, A1, " "),
    !,
    sub_string(Rest, 0, B1, _, N0),
    sub_string(Rest, _, A1, 0, Key0),
    atom_string(Kind, Kind0),
    number_string(N, N0),
    atom_string(Key, Key0).

%   With appendfsync everysec an engine that dies may forget that this process
%   has taken the journal over.  Nothing is committed, and so nothing sent,
%   before that is on its disk; the first commit compares the owner once more.

settle(Taken, Fleet) :-
    (   Taken =:= 1,
        \+ syncs(Fleet)
    ->  deadline(1.1, Stamp),
        assertz(settles(Stamp))
    ;   true
    ).

syncs(Fleet) :-
    fleet_joined(Fleet, Options),
    option(fsync(always), Options),
    !.

warn_of_loss(Sync, Fleet, Place) :-
    (   Sync == full,
        \+ syncs(Fleet)
    ->  print_message(warning, typhon(journal_not_synced(Place)))
    ;   true
    ).

typhon_store:backend_close(redis(_, _)) :-
    forall(owned(Journal, _, _), ends(Journal)).

ends(Journal) :-
    (   retract(owned(Journal, _, Server))
    ->  server_stop(Server)
    ;   give_back(Journal)
    ),
    retractall(settles(_)),
    retractall(numbers(_, _)),
    retractall(item(_, _, _, _)),
    retractall(unsent(_, _, _)).

give_back(Journal) :-
    catch(script(journal_renew, Journal, [0], _), error(_, _), true).

%   Beats of a member renew the lease.

typhon_members:journal(Fleet, Name, Owner) :-
    owned(journal(Fleet, Name, Owner, _), _, _).

script(Script, journal(Fleet, Name, Owner, Place), Args, Answer) :-
    in_terms_of(Place, engine_script(Fleet, Script, [Name,Owner|Args], Answer)).

                /*******************************
                *           THE THREAD         *
                *******************************/

:- public handle/5.

handle(Journal, Ttl, Message, Next0, until(Next, Next)) :-
    (   Message = call(commit(Changes), Caller)
    ->  commit(Changes, Journal, Ttl),
        server_answer(Caller, done),
        Next = Next0
    ;   Message == stop
    ->  give_back(Journal),
        Next = inf
    ;   renew(Journal, Ttl),
        Third is Ttl/3000,
        deadline(Third, Next)
    ).

renew(Journal, Ttl) :-
    Journal = journal(Fleet, _, _, _),
    (   fleet_member(Fleet, _, _)
    ->  true
    ;   catch(script(journal_renew, Journal, [Ttl], _), error(_, _), true)
    ).

                /*******************************
                *            COMMIT            *
                *******************************/

typhon_store:backend_commit(redis(_, _), _, Changes) :-
    owned(_, _, Server),
    server_call(Server, commit(Changes), inf, done).

%   If a commit fails the same changes come again with the next one.

commit(Changes, Journal, Ttl) :-
    forall(member(Change, Changes), change(Change)),
    forall(retract(settles(Stamp)), sleep_until(Stamp)),
    changed(Puts, Drops),
    crash_point(in_commit),
    (   fits(Puts)
    ->  committed(none, Puts, Drops, Journal, Ttl, Answer)
    ;   put_parts([Puts], 1, Journal, Ttl),
        committed(parts, [], Drops, Journal, Ttl, Answer)
    ),
    concluded(Answer, Journal, Ttl).

sleep_until(Stamp) :-
    monotonic_time(Now),
    Seconds is max(0, Stamp-Now),
    sleep(Seconds).

change(put(Kind, Key, N, Bytes)) :-
    typhon_item_format:bytes_sum(Bytes, Sum),
    format(string(Shown), '~`0t~16r~6|', [Sum]),
    string_concat(Shown, Bytes, Value),
    set_item(Kind, Key, N, Value),
    touch(Kind, Key, N).
change(drop(Kind, Key, N)) :-
    retractall(item(Kind, Key, N, _)),
    touch(Kind, Key, N).
change(drop_all(Kind, Key)) :-
    forall(item(Kind, Key, N, _), change(drop(Kind, Key, N))).
change(drop_below(Kind, Key, Least)) :-
    forall(( item(Kind, Key, N, _), N < Least ), change(drop(Kind, Key, N))).

set_item(Kind, Key, N, Value) :-
    retractall(item(Kind, Key, N, _)),
    assertz(item(Kind, Key, N, Value)).

touch(Kind, Key, N) :-
    (   unsent(Kind, Key, N)
    ->  true
    ;   assertz(unsent(Kind, Key, N))
    ).

changed(Puts, Drops) :-
    findall(Field-Value,
            ( unsent(Kind, Key, N),
              item(Kind, Key, N, Value),
              field(Kind, Key, N, Field) ),
            Puts),
    findall(Field,
            ( unsent(Kind, Key, N),
              \+ item(Kind, Key, N, _),
              field(Kind, Key, N, Field) ),
            Drops).

%   committed(+How, +Puts, +Drops, +Journal, +Ttl, -Answer): see the script.

committed(How, Puts, Drops, Journal, Ttl, Answer) :-
    retract(numbers(Last, Number)),
    Next is Number+1,
    assertz(numbers(Last, Next)),       % also if it fails: never used again
    length(Puts, Count),
    flat(Puts, Fields),
    append([[Last,Number,Ttl,How,Count], Fields, Drops], Args),
    script(journal_commit, Journal, Args, Answer),
    (   Answer == "ok"
    ->  retractall(numbers(_, _)),
        assertz(numbers(Number, Next)),
        retractall(unsent(_, _, _))
    ;   true
    ).

flat([], []).
flat([Field-Value|Pairs], [Field,Value|Flat]) :-
    flat(Pairs, Flat).

concluded("ok", _, _).
concluded("fenced", journal(_, _, _, Place), _) :-
    not_opened(Place, 'another process has opened it meanwhile').
concluded("lost", Journal, Ttl) :-
    script(journal_claim, Journal, [Ttl], Answer),
    claimed(Answer, Journal, Ttl).

claimed("ok", Journal, Ttl) :-
    about(About),
    put_parts([["about"-About]], 1, Journal, Ttl),
    forall(findnsols(100, Field-Value,
                     ( item(Kind, Key, N, Value), field(Kind, Key, N, Field) ),
                     Pairs),
           put_parts([Pairs], 0, Journal, Ttl)),
    committed(all, [], [], Journal, Ttl, Answer),
    must_be_ok(Answer, Journal).
claimed("wait", journal(_, _, _, Place), _) :-
    throw(error(journal_unreachable(Place, 'the engine came back empty'), _)).
claimed("fenced", Journal, Ttl) :-
    concluded("fenced", Journal, Ttl).

must_be_ok(Answer, Journal) :-
    (   Answer == "lost"
    ->  claimed("wait", Journal, _)
    ;   concluded(Answer, Journal, _)
    ).

%   put_parts(+Lists, +First, +Journal, +Ttl): a call of the engine takes a list
%   that is not too long.

put_parts([], _, _, _).
put_parts([Puts|Lists], First, Journal, Ttl) :-
    \+ fits(Puts),
    Puts = [_, _|_],
    !,
    length(Puts, Count),
    Half is Count//2,
    length(Front, Half),
    append(Front, Back, Puts),
    put_parts([Front, Back|Lists], First, Journal, Ttl).
put_parts([Puts|Lists], First, Journal, Ttl) :-
    flat(Puts, Fields),
    script(journal_part, Journal, [Ttl, First|Fields], Answer),
    must_be_ok(Answer, Journal),
    put_parts(Lists, 0, Journal, Ttl).

part_bytes(2000000).

fits(Puts) :-
    part_bytes(Most),
    fits(Puts, Most).

fits([], Left) :-
    Left >= 0.
fits([_-Value|Puts], Left0) :-
    Left0 >= 0,
    string_length(Value, Length),
    Left is Left0-Length-100,
    fits(Puts, Left).

                /*******************************
                *             ITEMS            *
                *******************************/

typhon_store:backend_item(redis(_, _), Kind, Order, Key, N, Bytes, Sum) :-
    findall(N0-Key0, item(Kind, Key0, N0, _), Pairs0),
    (   Order == numbers
    ->  keysort(Pairs0, Pairs)
    ;   Pairs = Pairs0
    ),
    member(N-Key, Pairs),
    item(Kind, Key, N, Value),
    sub_string(Value, 0, 6, _, Shown),
    sub_string(Value, 6, _, 0, Bytes),
    string_concat("0x", Shown, Hex),
    ( number_string(Sum, Hex) -> true ; Sum = none ).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:error_message(domain_error(fleet_journal, Path)) -->
    [ 'redis(~q) names no journal: redis(\'FLEET/NAME\') does'-[Path] ].

prolog:message(typhon(journal_not_synced(Place))) -->
    [ 'The journal ~w does not survive a power cut, as sync(full) asks: \c
       join the fleet with fsync(always), and let the engine have \c
       `appendfsync always`'-[Place] ].
