:- module(typhon_listening,
          [ listening_begin/2,          % +Watch, -Queue
            listening_end/1,            % +Watch
            listening_tell/2,           % +Watch, +Message
            listen_on/4                 % +Watch, +Queue, :OnEvent, +Asked
          ]).
:- use_module(library(lists), [delete/3, member/2, min_list/2]).
:- use_module('../base/output', [output_own/0]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_reply/2, endpoint_request/4]).
:- use_module('../host', [address_parts/3, time_now/1]).

/** <module> Listening to what is told

The places of a watch are the processes that have hosts which are watched.
State of a place is `up`, `cut` while it is asked whether it is there still,
or down(Again, Pause): nobody was there, and it is asked again at the time
Again, when it has not come by itself before.

A process that was cut off is asked to watch again.  If it has forgotten the
watch, as one that was started anew has, events are missing: its hosts are
lost, and those that are there have started.

*Threading*: one thread for each watch, which alone changes its places.  The
hooks of the endpoint put into its queue what it is to hear.
*/

:- meta_predicate listen_on(+, +, 1, +).

:- multifile
    prolog:message//1,
    typhon_endpoint:connection/2,
    typhon_endpoint:requested/4,
    typhon_telling:taken_here/3.

:- dynamic
    watch/2,                    % Watch, Queue: as long as events are wanted
    place/4,                    % Watch, Endpoint, Peer, Wanted
    state/3,                    % Watch, Endpoint, State
    runs/4.                     % Watch, Endpoint, Host, Clock: is known to

longest_pause(60).

%!  listening_begin(+Watch, -Queue) is det.
%!  listening_end(+Watch) is det.
%
%   From now on events of Watch are wanted, which come into Queue; or none
%   are any more, and its thread ends.

listening_begin(Watch, Queue) :-
    message_queue_create(Queue),
    assertz(watch(Watch, Queue)).

listening_end(Watch) :-
    ignore(listening_tell(Watch, over)),
    retractall(watch(Watch, _)).

                /*******************************
                *           THE WIRE           *
                *******************************/

typhon_endpoint:requested(watched, events(Watch, Events), Peer, ReplyTo) :-
    (   listening_tell(Watch, events(Peer, Events, peer(ReplyTo)))
    ->  true
    ;   endpoint_reply(ReplyTo, no)
    ).
typhon_telling:taken_here(Watch, Events, OnAnswer) :-
    endpoint_address(Own),
    !,
    listening_tell(Watch, events(Own, Events, here(OnAnswer))).
typhon_endpoint:requested(watched, alive(Watch), _, ReplyTo) :-
    (   watch(Watch, _)
    ->  endpoint_reply(ReplyTo, yes)
    ;   endpoint_reply(ReplyTo, no)
    ).

typhon_endpoint:connection(Peer, State) :-
    forall(watch(Watch, _), ignore(listening_tell(Watch, connection(Peer, State)))).

%!  listening_tell(+Watch, +Message) is semidet.
%
%   Fails if nobody listens.

listening_tell(Watch, Message) :-
    watch(Watch, Queue),
    catch(thread_send_message(Queue, Message),
          error(existence_error(_, _), _),
          fail).

                /*******************************
                *           THE LOOP           *
                *******************************/

%!  listen_on(+Watch, +Queue, :OnEvent, +Asked) is det.
%
%   The thread of Watch, until listening_end/1, or the message end(Done): then
%   what has happened until then is taken, too, and the queue Done hears
%   `done`.  Asked are asked(Endpoint, Wanted, Answer), Answer being what a
%   teller says, or gone(Hosts) of a process of a network that is no more.

listen_on(Watch, Queue, OnEvent, Asked) :-
    output_own,
    Me = me(Watch, Queue, OnEvent),
    setup_call_cleanup(
        forall(member(One, Asked), begin(One, Me)),
        loop(Me),
        ( forget(Watch),
          message_queue_destroy(Queue) )).

begin(asked(Endpoint, Wanted, Answer), Me) :-
    Me = me(Watch, _, _),
    (   Answer = watching(Peer, _, Hosts)
    ->  assertz(place(Watch, Endpoint, Peer, Wanted)),
        put_state(Me, Endpoint, up),
        run(Hosts, Endpoint, Me)
    ;   Answer = gone(Hosts),
        forall(member(Host, Hosts), lost(Host, clock(0, 1), Me))
    ).

forget(Watch) :-
    retractall(watch(Watch, _)),
    retractall(place(Watch, _, _, _)),
    retractall(state(Watch, _, _)),
    retractall(runs(Watch, _, _, _)).

put_state(me(Watch, _, _), Endpoint, State) :-
    retractall(state(Watch, Endpoint, _)),
    assertz(state(Watch, Endpoint, State)).

run(Hosts, Endpoint, me(Watch, _, _)) :-
    forall(member(Host-Clock, Hosts),
           assertz(runs(Watch, Endpoint, Host, Clock))).

loop(Me) :-
    next(Me, Message),
    (   Message = end(Done)
    ->  end(Me),
        thread_send_message(Done, done)
    ;   heard(Message, Me),
        wanted(Me)
    ->  loop(Me)
    ;   unwatch_all(Me)
    ).

next(me(Watch, Queue, _), Message) :-
    findall(Again, state(Watch, _, down(Again, _)), Agains),
    (   Agains == []
    ->  thread_get_message(Queue, Message)
    ;   min_list(Agains, Deadline),
        (   thread_get_message(Queue, Message0, [deadline(Deadline)])
        ->  Message = Message0
        ;   Message = due
        )
    ).

wanted(me(Watch, _, _)) :-
    watch(Watch, _).

heard(events(Peer, Events, ReplyTo), Me) =>
    ask_for_more(ReplyTo),
    forall(( member(Event, Events), wanted(Me) ),
           taken(Event, Peer, Me)).
heard(connection(Peer, down), Me) =>
    forall(place_at(Peer, up, Endpoint, Me), ask_again(Endpoint, Me)).
heard(connection(Peer, up), Me) =>
    forall(place_at(Peer, down(_, _), Endpoint, Me),
           ask_again(Endpoint, Me)).
heard(due, Me) =>
    get_time(Now),
    Me = me(Watch, _, _),
    forall(( state(Watch, Endpoint, down(Again, _)), Again =< Now ),
           ask_again(Endpoint, Me)).
heard(asked(Endpoint, Result), Me) =>
    answered(Result, Endpoint, Me).
heard(_, _) =>                          % over, ended(_)
    true.

ask_for_more(peer(ReplyTo)) :-
    endpoint_reply(ReplyTo, more).
ask_for_more(here(OnAnswer)) :-
    call(OnAnswer, answer(more)).

                /*******************************
                *            EVENTS            *
                *******************************/

%   What has been concluded already is not told again.

taken(event(Time, Host, none, started(Clock)), Peer, Me) =>
    Me = me(Watch, _, _),
    (   runs(Watch, _, Host, _)
    ->  true
    ;   forall(place_at(Peer, _, Endpoint, Me),
               run([Host-Clock], Endpoint, Me)),
        call_on(event(Time, Host, none, started), Me)
    ).
taken(event(Time, Host, none, stopped), _, Me) =>
    Me = me(Watch, _, _),
    retractall(runs(Watch, _, Host, _)),
    call_on(event(Time, Host, none, stopped), Me).
taken(Event, _, Me) =>
    call_on(Event, Me).

call_on(Event, me(Watch, _, OnEvent)) :-
    (   catch(call(OnEvent, Event), Ball, raised(Ball, Watch))
    ->  true
    ;   true
    ).

%   Who is told to end must.

raised(Ball, _) :-
    is_abort(Ball),
    !,
    throw(Ball).
raised(Ball, Watch) :-
    (   nb_current(typhon_watch_warned, true)
    ->  true
    ;   nb_setval(typhon_watch_warned, true),
        print_message(warning, typhon(watch_raised(Watch, Ball)))
    ).

is_abort('$aborted').
is_abort(unwind(_)).

lost(Host, clock(Epoch, Rate), Me) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate,
    call_on(event(Time, Host, none, lost), Me).

                /*******************************
                *         CUT AND LOST         *
                *******************************/

%   This process is never cut off from itself.

place_at(Peer, State, Endpoint, me(Watch, _, _)) :-
    \+ ( State == up, endpoint_address(Peer) ),
    place(Watch, Endpoint, Peer, _),
    state(Watch, Endpoint, State).

ask_again(Endpoint, Me) :-
    Me = me(Watch, Queue, _),
    place(Watch, Endpoint, _, Wanted),
    !,
    pause(Endpoint, Me, Pause),
    put_state(Me, Endpoint, cut(Pause)),
    endpoint_request(Endpoint, watch, watch(Watch, Wanted),
                     typhon_listening:told(Queue, asked, Endpoint)).

pause(Endpoint, me(Watch, _, _), Pause) :-
    (   state(Watch, Endpoint, down(_, Pause0))
    ->  Pause = Pause0
    ;   Pause = 1
    ).

:- public told/4.

told(Queue, What, Endpoint, Result) :-
    Message =.. [What, Endpoint, Result],
    catch(thread_send_message(Queue, Message),
          error(existence_error(_, _), _),
          true).                        % nobody listens any more

answered(answer(watching(_, New, Hosts)), Endpoint, Me) :-
    !,
    (   New == true
    ->  all_lost(Endpoint, Me)
    ;   true
    ),
    put_state(Me, Endpoint, up),
    forall(( member(Host-Clock, Hosts),
             \+ is_running(Host, Me) ),
           ( run([Host-Clock], Endpoint, Me),
             started(Host, Clock, Me) )).
answered(_, Endpoint, Me) :-
    Me = me(Watch, _, _),
    state(Watch, Endpoint, cut(Pause)),
    !,
    findall(Host, runs(Watch, Endpoint, Host, _), Hosts),
    all_lost(Endpoint, Me),
    (   still_wanted(Endpoint, Hosts, Me)
    ->  again_later(Endpoint, Pause, Me)
    ;   retractall(place(Watch, Endpoint, _, _)),
        retractall(state(Watch, Endpoint, _))
    ).
answered(_, _, _).

%   Another process may have the port by and by: of a network only hosts that
%   were there are waited for.

still_wanted(Endpoint, Hosts, me(Watch, _, _)) :-
    place(Watch, Endpoint, Peer, Wanted),
    !,
    (   Wanted == all
    ->  Hosts = [_|_],
        findall(Name,
                ( member(Host, Hosts), address_parts(Host, Name, _) ), Names),
        retractall(place(Watch, Endpoint, _, _)),
        assertz(place(Watch, Endpoint, Peer, Names))
    ;   true
    ).

again_later(Endpoint, Pause, Me) :-
    get_time(Now),
    Again is Now+Pause,
    longest_pause(Longest),
    Next is min(Longest, 2*Pause),
    put_state(Me, Endpoint, down(Again, Next)).

is_running(Host, me(Watch, _, _)) :-
    runs(Watch, _, Host, _),
    !.

started(Host, clock(Epoch, Rate), Me) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate,
    call_on(event(Time, Host, none, started), Me).

all_lost(Endpoint, Me) :-
    Me = me(Watch, _, _),
    findall(Host-Clock, runs(Watch, Endpoint, Host, Clock), Lost),
    retractall(runs(Watch, Endpoint, _, _)),
    forall(member(Host-Clock, Lost), lost(Host, Clock, Me)).

                /*******************************
                *              END             *
                *******************************/

%   All that has happened is told before the last place has ended.

end(Me) :-
    unwatch_all(Me),
    Me = me(Watch, _, _),
    findall(Endpoint, state(Watch, Endpoint, up), Endpoints),
    await_ends(Endpoints, Me).

await_ends([], _) :-
    !.
await_ends(Endpoints, Me) :-
    wanted(Me),
    !,
    Me = me(_, Queue, _),
    thread_get_message(Queue, Message),
    (   Message = ended(Endpoint, _)
    ->  delete(Endpoints, Endpoint, Others),
        await_ends(Others, Me)
    ;   Message = events(_, _, _)
    ->  heard(Message, Me),
        await_ends(Endpoints, Me)
    ;   await_ends(Endpoints, Me)
    ).
await_ends(_, _).                       % it takes too long

unwatch_all(me(Watch, Queue, _)) :-
    forall(state(Watch, Endpoint, up),
           endpoint_request(Endpoint, watch, unwatch(Watch),
                            typhon_listening:told(Queue, ended, Endpoint))).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(watch_raised(Watch, Ball))) -->
    [ 'What is called for ~w raises an exception; the watch goes on: '-[Watch] ],
    '$messages':translate_message(Ball).
