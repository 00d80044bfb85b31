:- module(typhon_nxt_link,
          [ link_open/3,                % +Brick, +Port, +Options
            link_close/1,               % +Brick
            link_request/4,             % +Brick, +What, +Fields, -Reply
            link_request/5,             % +Brick, +What, +Fields, +Seconds,
                                        % -Reply
            link_option/2,              % +Brick, ?Option
            link_brick/2                % ?Brick, ?Port
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(json, [atom_json_dict/3]).
:- use_module(library(lists), [member/2, selectchk/3]).
:- use_module(library(option), [option/3]).
:- use_module('../base/own_thread', [in_own_thread/1]).
:- use_module(errors, [nxt_failure/4]).
:- use_module(helper,
              [ helper_end/1, helper_kill/1, helper_release/1,
                helper_start/3, helper_write/2
              ]).

/** <module> Requests to bricks, and their answers

Every brick that is connected has a thread that owns its helper.  It starts
the helper when there is something to be done and none is running, so one
that died is replaced by the next request.  Requests pass to the helper in
the order in which they come, and it serves them one after the other;
different bricks have different helpers.

The helper ends what it does at the deadline of the request.  Who asked
waits two seconds longer, then kills a helper that has not answered, so
nothing hangs.

*Threading*: any thread may ask.  It waits for its answer at a queue of its
own, so what comes too late is for nobody.
*/

:- dynamic
    brick/4.                    % Brick, Port, Options, Owner thread

grace_seconds(2).
stop_seconds(5).

%!  link_open(+Brick, +Port, +Options) is det.
%
%   @error permission_error(connect, nxt_brick, Brick) if it is connected

link_open(Brick, Port, Options) :-
    with_mutex(typhon_nxt, open_link(Brick, Port, Options)).

open_link(Brick, _, _) :-
    brick(Brick, _, _, _),
    !,
    permission_error(connect, nxt_brick, Brick).
open_link(Brick, Port, Options) :-
    State = state(Brick, Port, Options, none, [], none),
    owner_alias(Brick, Alias),
    sig_atomic(( thread_create(own(State), Owner, [alias(Alias)]),
                 assertz(brick(Brick, Port, Options, Owner)) )).

%   One that is closed may have its name still.

owner_alias(Brick, Alias) :-
    flag(typhon_nxt_owner, N, N+1),
    atomic_list_concat([typhon_nxt, Brick, N], '_', Alias).

%!  link_close(+Brick) is det.
%
%   End the helper.  Requests that are still open get an error.
%
%   @error existence_error(nxt_brick, Brick)

link_close(Brick) :-
    in_own_thread(close_link(Brick)).

close_link(Brick) :-
    (   retract(brick(Brick, _, _, Owner))
    ->  true
    ;   existence_error(nxt_brick, Brick)
    ),
    thread_self(Me),
    thread_send_message(Owner, stop(Me)),
    stop_seconds(Seconds),
    (   thread_get_message(Me, stopped(Owner), [timeout(Seconds)])
    ->  true
    ;   helper_kill(Owner)
    ),
    thread_join(Owner, _).

%!  link_brick(?Brick, ?Port) is nondet.

link_brick(Brick, Port) :-
    brick(Brick, Port, _, _).

%!  link_option(+Brick, ?Option) is nondet.
%
%   @error existence_error(nxt_brick, Brick)

link_option(Brick, Option) :-
    the_brick(Brick, _, Options, _),
    member(Option, Options).

the_brick(Brick, Port, Options, Owner) :-
    (   brick(Brick, Port, Options, Owner)
    ->  true
    ;   existence_error(nxt_brick, Brick)
    ).

%!  link_request(+Brick, +What, +Fields, -Reply) is det.
%!  link_request(+Brick, +What, +Fields, +Seconds, -Reply) is det.
%
%   Have the helper of Brick do What, a command of LEGO's document or what
%   the helper can do, with the dict Fields.  Reply is a dict.  Seconds is
%   the deadline, default that of the brick.
%
%   @error existence_error(nxt_brick, Brick)
%   @error See nxt_failure/4

link_request(Brick, What, Fields, Reply) :-
    the_brick(Brick, _, Options, _),
    option(deadline(Seconds), Options, 3),
    link_request(Brick, What, Fields, Seconds, Reply).

link_request(Brick, What, Fields, Seconds, Reply) :-
    the_brick(Brick, Port, _, Owner),
    flag(typhon_nxt_request, Id, Id+1),
    Request = Fields.put(_{id:Id, timeout:Seconds}),
    atom_json_dict(Line, Request, [as(string), width(0)]),
    setup_call_cleanup(
        message_queue_create(Queue),
        ask(Brick, Owner, request(Id, Queue, Line), Seconds, Answer),
        message_queue_destroy(Queue)),
    (   Answer = ok(Reply)
    ->  true
    ;   nxt_failure(Answer, Brick, Port, What)
    ).

ask(Brick, Owner, Request, Seconds, Answer) :-
    Request = request(_, Queue, _),
    catch(thread_send_message(Owner, Request),
          error(existence_error(_, _), _),
          existence_error(nxt_brick, Brick)),
    grace_seconds(Grace),
    Longest is Seconds+Grace,
    (   thread_get_message(Queue, answer(Answer0), [timeout(Longest)])
    ->  Answer = Answer0
    ;   helper_kill(Owner),
        Answer = stuck
    ).

                /*******************************
                *           THE OWNER          *
                *******************************/

%   State is state(Brick, Port, Options, Helper, Open, Fatal): Helper may be
%   `none`, Open are the requests without an answer, Id-Queue, and Fatal is
%   what the helper said of itself before it ended, or `none`.

own(State0) :-
    thread_get_message(Message),
    handle(Message, State0, State),
    !,
    (   State = stopped(Brick)
    ->  forget(Brick)
    ;   own(State)
    ).

handle(request(Id, Queue, Line), S0, S) :-
    S0 = state(Brick, Port, Options, none, [], _),
    !,
    catch(( helper_start(Port, Options, Helper),
            S1 = state(Brick, Port, Options, Helper, [], none),
            handle(request(Id, Queue, Line), S1, S)
          ),
          error(Formal, Context),
          ( answer(Queue, error(Formal, Context)), S = S0 )).
handle(request(Id, Queue, Line), S0, S) :-
    S0 = state(Brick, Port, Options, Helper, Open, Fatal),
    helper_write(Helper, Line),
    S = state(Brick, Port, Options, Helper, [Id-Queue|Open], Fatal).
handle(heard(Dict), S0, S) :-
    S0 = state(Brick, Port, Options, Helper, Open0, _),
    !,
    (   get_dict(id, Dict, Id),
        selectchk(Id-Queue, Open0, Open)
    ->  answer_of(Dict, Answer),
        answer(Queue, Answer),
        S1 = state(Brick, Port, Options, Helper, Open, none)
    ;   get_dict(error, Dict, _)
    ->  S1 = state(Brick, Port, Options, Helper, Open0, said(Dict))
    ;   S1 = S0
    ),
    S = S1.
handle(ended(Status), S0, S) :-
    S0 = state(Brick, Port, Options, Helper, Open, Fatal),
    helper_release(Helper),
    debug(typhon(nxt), 'the helper of ~w ended: ~p', [Brick, Status]),
    (   Fatal = said(_)
    ->  Answer = Fatal
    ;   Answer = died(Status)
    ),
    forall(member(_-Queue, Open), answer(Queue, Answer)),
    S = state(Brick, Port, Options, none, [], none).
handle(stop(Who), state(Brick, _, _, Helper, Open, _), stopped(Brick)) :-
    forall(member(_-Queue, Open), answer(Queue, closed)),
    stop(Helper),
    thread_self(Me),
    thread_send_message(Who, stopped(Me)).

stop(none).
stop(Helper) :-
    Helper = helper(_, _),
    helper_write(Helper, "{\"id\": 0, \"do\": \"quit\"}"),
    helper_end(Helper),
    thread_get_message(ended(_)),
    helper_release(Helper).

%   What was asked after the order to stop.

forget(Brick) :-
    thread_self(Me),
    (   thread_peek_message(Me, request(_, _, _))
    ->  thread_get_message(request(_, Queue, _)),
        answer(Queue, closed),
        forget(Brick)
    ;   true
    ).

answer_of(Dict, ok(Reply)) :-
    get_dict(ok, Dict, Reply),
    !.
answer_of(Dict, said(Dict)).

answer(Queue, Answer) :-
    catch(thread_send_message(Queue, answer(Answer)),
          error(existence_error(_, _), _),
          true).                        % nobody waits any more
