:- module(typhon_watches,
          [ watch_begin/3,              % +Hosts, :OnEvent, -Watch
            watch_end/1                 % +Watch
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/own_thread',
              [in_own_thread/1, stop_thread/1]).
:- use_module('../../kernel/wire', [endpoint_request/4]).
:- use_module('../../kernel/host',
              [ address_parts/3, host_unknown/1, process_ask/6,
                runtime_acquire/2, runtime_release/1 ]).
:- use_module(watch_receiver,
              [ receiver_close/1, receiver_open/2, receiver_put/2,
                receiver_run/4 ]).
:- use_module(watched_hosts, [watched_places/2]).

/** <module> Watches of this process

A watch has a thread, which calls OnEvent, see module `watch_receiver`.  The
processes of the hosts send the events, see module `watch_senders`.

*Threading*: any thread may call; the thread of a watch may end it, too.
*/

:- setting(last_seconds, number, 2,
           "Seconds that unwatch/1 waits for earlier events").

:- meta_predicate watch_begin(+, :, -).

:- dynamic watch_thread/2.      % Watch, Thread

%!  watch_begin(+Hosts, :OnEvent, -Watch) is det.
%
%   See watch/3.

watch_begin(Hosts, OnEvent, Watch) :-
    must_be(var, Watch),
    strip_module(OnEvent, _, Plain),
    must_be(callable, Plain),
    flag(typhon_watches, N, N+1),
    atom_concat(watch, N, Id),
    once(setup_call_catcher_cleanup(
             runtime_acquire(watch(Id), []),
             begin(Id, Hosts, OnEvent),
             Catcher,
             release_unless_begun(Catcher, Id))),
    Watch = Id.

begin(Id, Hosts, OnEvent) :-
    watched_places(Hosts, Places),
    receiver_open(Id, Queue),
    catch(start_thread(Places, Id, Queue, OnEvent), Ball,
          ( undo_begin(Places, Id, Queue),
            throw(Ball) )).

start_thread(Places, Id, Queue, OnEvent) :-
    findall(Asked, ( member(Place, Places), ask(Place, Id, Asked) ), All),
    atom_concat(typhon_, Id, Alias),
    thread_create(receiver_run(Id, Queue, OnEvent, All), Thread,
                  [alias(Alias)]),
    assertz(watch_thread(Id, Thread)).

undo_begin(Places, Id, Queue) :-
    receiver_close(Id),
    message_queue_destroy(Queue),
    forall(member(place(Endpoint, _, _), Places),
           endpoint_request(Endpoint, watch, unwatch(Id), ignored)).

:- public ignored/1.

ignored(_).

release_unless_begun(exit, _) :-
    !.
release_unless_begun(_, Id) :-
    in_own_thread(runtime_release(watch(Id))).

%   ask(+Place, +Id, -Asked): request the events of the watch Id from Place.  If
%   the process is one of a network, it may have ended.

ask(place(Endpoint, Wanted, Hosts), Id, asked(Endpoint, Wanted, Answer)) :-
    (   Hosts = asked([_-Who|_])
    ->  true
    ;   Who = Endpoint
    ),
    catch(process_ask(Endpoint, Who, watch, watch(Id, Wanted), Answer, 10),
          error(Formal, Context),
          process_gone(Hosts, error(Formal, Context), Answer)),
    must_have_hosts(Hosts, Answer).

process_gone(carried(Addresses), _, Answer) =>
    Answer = gone(Addresses).
process_gone(_, Error, _) =>
    throw(Error).

must_have_hosts(asked(Hosts), watching(_, _, There)) =>
    forall(( member(Name-Host, Hosts),
             \+ ( member(Address-_, There),
                  address_parts(Address, Name, _) ) ),
           host_unknown(Host)).
must_have_hosts(carried(_), _) =>
    true.

%!  watch_end(+Watch) is det.
%
%   See unwatch/1.

watch_end(Watch) :-
    must_be(atom, Watch),
    (   with_mutex(typhon_watches, retract(watch_thread(Watch, Thread)))
    ->  end(Watch, Thread)
    ;   existence_error(watch, Watch)
    ).

%   If the thread of the watch ends it, it cannot wait for earlier events, and
%   delivers none.

end(Watch, Thread) :-
    thread_self(Me),
    (   thread_property(Me, id(Id)),
        thread_property(Thread, id(Id))
    ->  receiver_close(Watch),
        thread_detach(Me)
    ;   in_own_thread(end_from_outside(Watch, Thread))
    ),
    runtime_release(watch(Watch)).

end_from_outside(Watch, Thread) :-
    setting(last_seconds, Seconds),
    setup_call_cleanup(
        message_queue_create(Done),
        ( receiver_put(Watch, end(Done)),
          ignore(thread_get_message(Done, done, [timeout(Seconds)]))
        ),
        message_queue_destroy(Done)),
    receiver_close(Watch),
    stop_thread(Thread).
