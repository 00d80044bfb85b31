:- module(typhon_watches,
          [ watch/3,                    % +Hosts, :OnEvent, -Watch
            unwatch/1                   % +Watch
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/base/stop_thread', [stop_thread/1]).
:- use_module('../../kernel/wire', [endpoint_request/4]).
:- use_module('../../kernel/host',
              [ address_parts/3, host_unknown/1, process_ask/6,
                runtime_acquire/2, runtime_release/1 ]).
:- use_module(listening,
              [ listen_on/4, listening_begin/2, listening_end/1,
                listening_tell/2 ]).
:- use_module(watched, [watched_places/2]).

/** <module> Watching hosts

A watch has a thread, which calls OnEvent, see module `listening`.
What it hears comes from the tellers of the processes that have the hosts, see
module `telling`.

*Threading*: any thread may call; a watch may be ended in its own thread.
*/

:- setting(last_seconds, number, 2,
           "unwatch/1 waits so long for what has happened before").

%   `:` and not 1: lambda expressions in arguments that are called are compiled
%   while a file is loaded, and lose there what is not a parameter.

:- meta_predicate watch(+, :, -).

:- dynamic listens/2.           % Watch, Thread

%!  watch(+Hosts, :OnEvent, -Watch) is det.
%
%   Have call(OnEvent, Event) called for what happens on Hosts from now on:
%   a host, a network, or a list of such, of this process and of others.
%   Event is event(Time, Host, Agent, What), Time in seconds of the clock of
%   Host, Host an address, Agent an id or `none`, and What is one of
%
%     - created, ended(Outcome), fault(Fault)
%       An agent begins, ends, or is faulty, Fault being as of
%       agent_property/2; one that is faulty ends when it is given up.
%     - left(To), arrived(From, Seconds), stayed(To)
%       It sets out for To; is there, after a hop of so many seconds; could
%       not go there.
%     - cloned(Id), sent(To), received(From), log(Term)
%       On hosts whose option log(Address, Kinds) has messages(content),
%       sent(To, Message) and received(From, Message).
%     - leave(Fact), take(Fact)
%       What is put in the tuple space of Host, and taken out.
%     - link(To), unlink(To), started, stopped
%       Agent is `none`.
%     - refused(Agent, Reason)
%       Host did not admit Agent: the name of one that was to be created there,
%       or the id of one that was to come.  Reason is as of move_refused/2.
%       Agent of the event is `none`.
%     - lost
%       The process of Host has ended or cannot be reached any more.  When it
%       is there again, Host has `started`.
%     - skipped(Count)
%       So many events of Host were not told: OnEvent is slower than they come.
%
%   Those of one host come in order.  All are called in one thread, one after
%   the other, and not where they happen: whatever OnEvent does, hosts do not
%   wait for it.  That it fails means nothing; an exception is reported once, and
%   the watch goes on.
%
%   OnEvent may be a lambda expression; its variables that are bound when
%   watch/3 is called are as they are then, as in [E]>>p(Q, E).
%
%   Watch holds the endpoint of this process until unwatch/1.
%
%   @error existence_error(host, Host)
%   @error host_unreachable(Host), permission_error(authenticate, host, Host)

watch(Hosts, OnEvent, Watch) :-
    must_be(var, Watch),
    strip_module(OnEvent, _, Plain),
    must_be(callable, Plain),
    flag(typhon_watches, N, N+1),
    atom_concat(watch, N, Id),
    once(setup_call_catcher_cleanup(
             runtime_acquire(watch(Id), []),
             begin(Id, Hosts, OnEvent),
             Catcher,
             unless_begun(Catcher, Id))),
    Watch = Id.

begin(Id, Hosts, OnEvent) :-
    watched_places(Hosts, Places),
    listening_begin(Id, Queue),
    catch(listen(Places, Id, Queue, OnEvent), Ball,
          ( give_up(Places, Id, Queue),
            throw(Ball) )).

listen(Places, Id, Queue, OnEvent) :-
    findall(Asked, ( member(Place, Places), ask(Place, Id, Asked) ), All),
    atom_concat(typhon_, Id, Alias),
    thread_create(listen_on(Id, Queue, OnEvent, All), Thread,
                  [alias(Alias)]),
    assertz(listens(Id, Thread)).

give_up(Places, Id, Queue) :-
    listening_end(Id),
    message_queue_destroy(Queue),
    forall(member(place(Endpoint, _, _), Places),
           endpoint_request(Endpoint, watch, unwatch(Id), ignored)).

:- public ignored/1.

ignored(_).

unless_begun(exit, _) :-
    !.
unless_begun(_, Id) :-
    in_own_thread(runtime_release(watch(Id))).

%   ask(+Place, +Id, -Asked): a process of a network may be no more.

ask(place(Endpoint, Wanted, Hosts), Id, asked(Endpoint, Wanted, Answer)) :-
    (   Hosts = asked([_-Who|_])
    ->  true
    ;   Who = Endpoint
    ),
    catch(process_ask(Endpoint, Who, watch, watch(Id, Wanted), Answer, 10),
          error(Formal, Context),
          unheard(Hosts, error(Formal, Context), Answer)),
    must_have(Hosts, Answer).

unheard(carried(Addresses), _, Answer) =>
    Answer = gone(Addresses).
unheard(_, Error, _) =>
    throw(Error).

must_have(asked(Hosts), watching(_, _, There)) =>
    forall(( member(Name-Host, Hosts),
             \+ ( member(Address-_, There),
                  address_parts(Address, Name, _) ) ),
           host_unknown(Host)).
must_have(carried(_), _) =>
    true.

                /*******************************
                *             END              *
                *******************************/

%!  unwatch(+Watch) is det.
%
%   Earlier events are still delivered, if that can be done in two seconds, and
%   then no event any more.
%
%   @error existence_error(watch, Watch)

unwatch(Watch) :-
    must_be(atom, Watch),
    (   with_mutex(typhon_watches, retract(listens(Watch, Thread)))
    ->  end(Watch, Thread)
    ;   existence_error(watch, Watch)
    ).

%   Ended in its own thread, it delivers nothing more.

end(Watch, Thread) :-
    thread_self(Me),
    (   thread_property(Me, id(Id)),
        thread_property(Thread, id(Id))
    ->  listening_end(Watch),
        thread_detach(Me)
    ;   in_own_thread(end_from_outside(Watch, Thread))
    ),
    runtime_release(watch(Watch)).

end_from_outside(Watch, Thread) :-
    setting(last_seconds, Seconds),
    setup_call_cleanup(
        message_queue_create(Done),
        ( listening_tell(Watch, end(Done)),
          ignore(thread_get_message(Done, done, [timeout(Seconds)]))
        ),
        message_queue_destroy(Done)),
    listening_end(Watch),
    stop_thread(Thread).
