:- module(typhon_fleet_watches,
          [ watch_fleet/3,              % +Fleet, :OnChange, -Watch
            unwatch_fleet/1             % +Watch
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [last/2, member/2, memberchk/2]).
:- use_module('../../kernel/base/error_text', [is_abort/1]).
:- use_module('../../kernel/base/monotonic', [wait_within/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1, stop_thread/1]).
:- use_module('../../kernel/base/reports', [report/4]).
:- use_module(engine, [engine/3, engine_key/3]).
:- use_module(members, [must_be_fleet/1]).

/** <module> Changes of a fleet, as they happen

The engine keeps the last ten thousand changes in a stream.  A watch has a
thread, which reads on from the change that it has read last: so each change is
seen once and in order, also those during a lost connection.

*Threading*: any thread; a watch may end itself.
*/

:- meta_predicate watch_fleet(+, :, -).

:- dynamic watching/3.          % Watch, Fleet, Thread

%!  watch_fleet(+Fleet, :OnChange, -Watch) is det.
%!  unwatch_fleet(+Watch) is det.
%
%   See fleet_watch/3 and fleet_unwatch/1.

watch_fleet(Fleet, OnChange, Watch) :-
    must_be_fleet(Fleet),
    must_be(var, Watch),
    newest(Fleet, Last),
    flag(typhon_fleet_watch, N, N+1),
    atom_concat(fleet_watch, N, Id),
    atom_concat(typhon_, Id, Alias),
    thread_create(begin(Id, Fleet, Last, OnChange), Thread, [alias(Alias)]),
    assertz(watching(Id, Fleet, Thread)),
    thread_send_message(Thread, begin),
    Watch = Id.

newest(Fleet, Last) :-
    engine_key(Fleet, [events], Key),
    (   catch(engine(Fleet, xinfo(stream, Key), Info),
              error(redis_error(_, _), _), fail), % there is none yet
        memberchk("last-generated-id"-Last0, Info)
    ->  Last = Last0
    ;   Last = '0-0'
    ).

unwatch_fleet(Watch) :-
    must_be(atom, Watch),
    (   retract(watching(Watch, _, Thread))
    ->  stop(Thread)
    ;   existence_error(fleet_watch, Watch)
    ).

stop(Thread) :-
    thread_self(Thread),
    !,
    thread_detach(Thread).
stop(Thread) :-
    catch(thread_send_message(Thread, stop), error(_, _), true),
    in_own_thread(stop_thread(Thread)).

begin(Watch, Fleet, Last, OnChange) :-
    thread_get_message(begin),
    watch(Watch, Fleet, Last, OnChange).

watch(Watch, Fleet, Last, OnChange) :-
    engine_key(Fleet, [events], Key),
    catch(( engine(Fleet, xread(count, 1000, block, 500, streams, Key, Last),
                   [_-Entries|_])
          -> true
          ;  Entries = [] ),
          error(Formal, Context),
          ( unread(Formal, Context), Entries = [] )),
    forall(( member([_,[What0,Host0]], Entries), watching(Watch, _, _) ),
           tell(OnChange, What0, Host0)),
    (   watching(Watch, _, _)
    ->  (   last(Entries, [New,_])
        ->  true
        ;   New = Last
        ),
        watch(Watch, Fleet, New, OnChange)
    ;   true
    ).

%   Outages end, and a fleet that was left may be joined again.

unread(Formal, Context) :-
    (   is_outage(Formal)
    ->  true
    ;   report(error, fleet_watches, watch, error(Formal, Context))
    ),
    thread_self(Me),
    ignore(wait_within(0.5, thread_get_message(Me, stop))).

is_outage(resource_error(fleet(_))).
is_outage(existence_error(fleet, _)).

tell(OnChange, What0, Host0) :-
    atom_string(What, What0),
    atom_string(Host, Host0),
    Change =.. [What,Host],
    catch(ignore(call(OnChange, Change)), Ball,
          ( is_abort(Ball)
          -> throw(Ball)
          ;  print_message(error, Ball) )).
