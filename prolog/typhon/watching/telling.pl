:- module(typhon_telling, []).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/output', [output_own/0]).
:- use_module('../base/stop_thread', [stop_thread/1]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_reply/2,
                endpoint_request/4, mobile_term/1 ]).
:- use_module('../host',
              [ clock/3, event_public/2, events_hear/3, events_unheard/1,
                host/3, time_kind/1, time_now/1 ]).
:- use_module(basin,
              [ basin_awaited/1, basin_close/1, basin_open/3, basin_put/3,
                basin_size/2, basin_take/4 ]).

/** <module> Telling those who watch

For each watch, of this process or another, that wants to hear of hosts of
this process there is a thread, the teller.  What happens gathers in a basin;
the teller sends it in batches, and the next when the last one is in the
hands of who watches.  So a watch is as far behind as it is slow, the basin
overflows where it is too slow, and hosts never wait.

A watch is forgotten when it is over, when its process says that it has none
of that name, or when that cannot be reached any more.

A process that watches asks with requests of kind `watch`, Wanted being names
of hosts, or `all`:

  | watch(Id, Wanted) | watching(Endpoint, New, Hosts), see room `watches` |
  | unwatch(Id)       | `ended`, when all that has happened has been told  |

It is told with requests of kind `watched`:

  | events(Id, Events) | `more`, or `no` if there is no such watch |
  | alive(Id)          | `yes` or `no`                             |

*Threading*: a teller for each watch.  It hears in its bell of what gathers,
and, as now(M), of what it has to heed at once.  Who takes its record away
joins it.
*/

:- multifile
    typhon_endpoint:connection/2,
    typhon_endpoint:requested/4,
    typhon_events:told/4,
    typhon_hosting:begins/1,
    typhon_runtime:ending/1,
    taken_here/3.               % Id, Events, OnAnswer

:- setting(events, positive_integer, 10 000,
           "So many events wait for one who watches and is slow").
:- setting(virtual_events, positive_integer, 1 000 000,
           "As many of virtual time, which is ahead of everybody").
:- setting(delay, number, 0.05,
           "Events gather for so many seconds before they are sent").
:- setting(patience, number, 30,
           "A process that watches and is cut off has so long to answer").

:- dynamic teller/5.            % Peer, Id, Thread, Bell, telling(Wanted, Basin)

kinds([life, faults, hops, messages, facts, said, links, hosts]).
batch(1000).
plenty(256).                    % is sent without delay

                /*******************************
                *         WHO WATCHES          *
                *******************************/

typhon_endpoint:requested(watch, watch(Id, Wanted), Peer, ReplyTo) :-
    with_mutex(typhon_telling, tell_to(Peer, Id, Wanted, New)),
    hear_of(New, Wanted, Peer, Id, Hosts),
    endpoint_address(Own),
    !,
    endpoint_reply(ReplyTo, watching(Own, New, Hosts)).
typhon_endpoint:requested(watch, unwatch(Id), Peer, ReplyTo) :-
    (   teller(Peer, Id, _, Bell, telling(_, Basin))
    ->  events_unheard(watch(Basin, _, _)),
        ring(Bell, end(ReplyTo))
    ;   endpoint_reply(ReplyTo, ended)
    ).

tell_to(Peer, Id, Wanted, New) :-
    retract(teller(Peer, Id, Thread, Bell, telling(_, Basin))),
    !,
    assertz(teller(Peer, Id, Thread, Bell, telling(Wanted, Basin))),
    New = false.
tell_to(Peer, Id, Wanted, true) :-
    message_queue_create(Bell),
    most(Most),
    basin_open(Most, Bell, Basin),
    flag(typhon_teller, N, N+1),
    atom_concat(typhon_teller_, N, Alias),
    thread_create(teller(Peer, Id, Bell, Basin), Thread, [alias(Alias)]),
    assertz(teller(Peer, Id, Thread, Bell, telling(Wanted, Basin))),
    debug(typhon(watch), '~w of ~w watches', [Id, Peer]).

most(Most) :-
    time_kind(virtual),
    !,
    setting(virtual_events, Most).
most(Most) :-
    setting(events, Most).

hear_of(New, Wanted, Peer, Id, Hosts) :-
    teller(Peer, Id, _, _, telling(_, Basin)),
    !,
    findall(Name-(Address-clock(Epoch, Rate)),
            ( host(Name, Address, _),
              is_wanted(Wanted, Name),
              clock(Name, Epoch, Rate) ),
            Pairs),
    forall(( New == true, member(Name-Host, Pairs) ),
           listen(Name, Host, Basin)),
    findall(Host, member(_-Host, Pairs), Hosts).
hear_of(_, _, _, _, []).

is_wanted(all, _).
is_wanted([Name0|Names], Name) :-
    memberchk(Name, [Name0|Names]).

listen(Name, Address-Clock, Basin) :-
    kinds(Kinds),
    events_hear(Kinds, Name, watch(Basin, Address, Clock)).

typhon_hosting:begins(Name) :-
    teller(_, _, _, _, telling(Wanted, Basin)),
    is_wanted(Wanted, Name),
    host(Name, Address, _),
    clock(Name, Epoch, Rate),
    listen(Name, Address-clock(Epoch, Rate), Basin).

typhon_endpoint:connection(Peer, down) :-
    forall(teller(Peer, _, _, Bell, _), ring(Bell, now(check))).

ring(Bell, Message) :-
    catch(thread_send_message(Bell, Message),
          error(existence_error(_, _), _),
          true).                        % it has ended

%   The last that happened, that the hosts stop, is told as well.

typhon_runtime:ending(before) :-
    findall(Thread,
            ( retract(teller(_, _, Thread, Bell, _)),
              ring(Bell, end(nobody)) ),
            Threads),
    forall(member(Thread, Threads), stop_thread(Thread)).

                /*******************************
                *           EVENTS             *
                *******************************/

typhon_events:told(watch(Basin, Address, Clock), _, Agent, What) :-
    time_at(Clock, Time),
    told_as(What, Clock, Public),
    catch(basin_put(Basin, Address-Clock,
                    event(Time, Address, Agent, Public)),
          error(existence_error(_, _), _),
          true).                        % it has ended

time_at(clock(Epoch, Rate), Time) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate.

%   Who watches has to know of clocks; agents may log what cannot travel.

told_as(started, Clock, Public) =>
    Public = started(Clock).
told_as(log(Term), _, Public) =>
    (   catch(mobile_term(Term), error(_, _), fail)
    ->  Public = log(Term)
    ;   format(atom(Text), '~q', [Term]),
        Public = log(Text)
    ).
told_as(What, _, Public) =>
    event_public(What, Public).

                /*******************************
                *         THE TELLER           *
                *******************************/

teller(Peer, Id, Bell, Basin) :-
    setup_call_cleanup(
        true,
        ( output_own,
          idle(to(Peer, Id, Bell, Basin)) ),
        teller_ends(Peer, Id, Bell, Basin)).

teller_ends(Peer, Id, Bell, Basin) :-
    debug(typhon(watch), '~w of ~w watches no more', [Id, Peer]),
    events_unheard(watch(Basin, _, _)),
    thread_self(Me),
    (   with_mutex(typhon_telling, retract(teller(Peer, Id, _, Bell, _)))
    ->  thread_detach(Me)
    ;   true
    ),
    basin_close(Basin),
    message_queue_destroy(Bell).

idle(To) :-
    To = to(_, _, Bell, Basin),
    basin_awaited(Basin),
    thread_get_message(Bell, Message),
    heard(Message, To, gather(To)).

gather(To) :-
    To = to(_, _, Bell, _),
    setting(delay, Seconds),
    (   thread_get_message(Bell, Message, [timeout(Seconds)])
    ->  heard(Message, To, gather(To))
    ;   pour(To)
    ).

%   heard(+Message, +To, :Next)

heard(some, _, Next) :-
    call(Next).
heard(now(check), To, Next) :-
    (   is_there(To)
    ->  call(Next)
    ;   true
    ).
heard(now(answered(_)), _, Next) :-
    call(Next).
heard(end(ReplyTo), To, _) :-
    pour_out(To),
    (   ReplyTo == nobody
    ->  true
    ;   endpoint_reply(ReplyTo, ended)
    ).

is_there(to(Peer, Id, _, _)) :-
    setting(patience, Seconds),
    catch(endpoint_call(Peer, watched, alive(Id), answer(Answer), Seconds),
          error(_, _), fail),
    Answer == yes.

pour(To) :-
    To = to(_, _, _, Basin),
    (   send(To)
    ->  (   basin_size(Basin, Size),
            plenty(Plenty),
            Size >= Plenty
        ->  pour(To)
        ;   idle(To)
        )
    ;   true                            % nobody watches any more
    ).

pour_out(To) :-
    To = to(_, _, _, Basin),
    (   basin_size(Basin, 0)
    ->  true
    ;   send(To)
    ->  pour_out(To)
    ;   true
    ).

%   send(+To) is semidet: the next batch is in the hands of who watches.
%   What is too long for a frame is halved, and a single event skipped.

send(To) :-
    To = to(_, _, _, Basin),
    batch(Most),
    basin_take(Basin, Most, Events0, Skipped),
    findall(Event, ( member(Lost, Skipped), skip_event(Lost, Event) ), More),
    append(Events0, More, Events),
    hand_over(Events, To).

hand_over(Events, To) :-
    To = to(Peer, Id, Bell, _),
    catch(( give(Peer, Id, Events, Bell),
            Given = true ),
          error(resource_error(_), _),
          Given = false),
    (   Given == true
    ->  await(To, answer(more))
    ;   hand_over_parts(Events, To)
    ).

hand_over_parts([event(Time, Host, _, _)], To) :-
    !,
    hand_over([event(Time, Host, none, skipped(1))], To).
hand_over_parts(Events, To) :-
    length(Events, Length),
    Half is Length//2,
    length(First, Half),
    append(First, Second, Events),
    hand_over(First, To),
    hand_over(Second, To).

%   Within this process nothing has to be sent.

give(Peer, Id, Events, Bell) :-
    endpoint_address(Peer),
    !,
    OnAnswer = typhon_telling:answered(Bell),
    (   taken_here(Id, Events, OnAnswer)
    ->  true
    ;   call(OnAnswer, answer(no))
    ).
give(Peer, Id, Events, Bell) :-
    endpoint_request(Peer, watched, events(Id, Events),
                     typhon_telling:answered(Bell)).

skip_event((Address-Clock)-Count,
           event(Time, Address, none, skipped(Count))) :-
    time_at(Clock, Time).

:- public answered/2.

answered(Bell, Result) :-
    ring(Bell, now(answered(Result))).

await(To, Answer) :-
    To = to(_, _, Bell, _),
    thread_get_message(Bell, now(Message)),
    (   Message = answered(Answer0)
    ->  Answer = Answer0
    ;   is_there(To),
        await(To, Answer)
    ).
