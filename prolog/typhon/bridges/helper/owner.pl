:- module(typhon_helper_owner,
          [ own/4,                      % +Me, +Message, +State0, -State
            own_state/2,                % +When, -State
            request_line/4,             % +Request, +Seconds, -Id, -Line
            said/3,                     % +Name, +Owner, +Dict
            answer_unwanted/1           % +Id
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../json', [json_text/2]).
:- use_module('../../kernel/base/server', [server_answer/2, server_self/1]).
:- use_module(process,
              [ process_begin/5, process_end/1, process_kill_of/1,
                process_release/1, process_write/2 ]).

/** <module> The server that owns the process of a helper

The owner starts the process, and writes the requests to it in their order.  In
the restart mode `always` the owner restarts a process that has ended at once;
if it ends soon again, after 0.1 seconds, then after twice that time, up to 10
seconds.  In the mode `asked`, or if the process has reported that a restart
would not help, the owner restarts it with the next request.

Requests and answers are JSON objects with the same id; an object without id but
with an `event` is unsolicited.

Numbers, strings, lists and dicts are the same in JSON and in Prolog, and so are
the atoms `null`, `true` and `false`, which are None, True and False in Python;
other atoms become strings.  Incoming values have the same form; strings stay
strings.

*Threading*: the server calls own/4 and the hook again/2.  The hook
handle_message/2 runs in the thread that reads the output of the helper.
Neither hook may wait for the helper.
*/

:- multifile
    again/2,                    % Name, Request: first requests, in this order,
                                % to a helper that was started again
    prolog:message//1.

soon(5).                        % seconds: a process that ends earlier failed

%!  own_state(+When, -State) is det.
%!  own(+Me, +Message, +State0, -State) is det.
%
%   Handle a Message to the server Me, owner(Name, Command, When, Role, Lines):
%   request(Id, Line), note(Line), `line`, for a line in the queue Lines, or
%   `quit`.
%
%   State is up(Process, Since, Wait), or down(Time, Wait, Answer): the process
%   is started at Time, or with the next request (`asked`), or `never`; until
%   then requests get Answer.  Wait is the next delay before a restart, if the
%   process ends soon, or `none` for a process that a request starts.

own_state(asked, down(asked, none, closed)).
own_state(always, until(0, down(0, first, closed))).

own(Me, Message, State0, Next) :-
    handle(Message, Me, State0, State),
    (   State = down(Time, _, _),
        number(Time)
    ->  Next = until(Time, State)
    ;   Next = State
    ).

%   If the server was restarted in a new thread, kill the process of the old
%   one.

handle(begin, _, State0, State) =>
    server_self(Owner),
    process_kill_of(Owner),
    State = State0.
handle(call(request(Id, Line), Caller), Me, State0, State) =>
    when_asked(State0, Me, State),
    write_request(State, Id, Caller, Line).
handle(line, Me, State0, State) =>
    Me = owner(_, _, _, _, Lines),
    thread_get_message(Lines, Line),
    when_asked(State0, Me, State),
    write_line(State, Line).
handle(note(Line), _, State0, State) =>
    State = State0,
    write_line(State, Line).
handle(timeout, Me, down(_, first, _), State) =>
    begin(Me, 0, State).
handle(timeout, Me, down(_, Wait, _), State) =>
    begin_again(Me, Wait, State).
handle(ended(Status), Me, up(Process, Since, Wait), State) =>
    process_release(Process),
    ended(Status, Me, Since, Wait, State).
handle(ended(_), _, State0, State) =>   % the process was killed
    State = State0.
handle(call(quit, Caller), _, State0, State) =>
    answer_all(closed),
    stop(State0),
    State = down(never, none, closed),
    server_answer(Caller, done).
handle(stop, _, State0, State) =>
    State = State0.

when_asked(down(asked, _, _), Me, State), Me = owner(_, _, always, _, _) =>
    begin_again(Me, 0, State).
when_asked(down(asked, _, _), Me, State) =>
    begin(Me, 0, State).
when_asked(State0, _, State) =>
    State = State0.

begin(owner(Name, Command, When, Role, _), Wait, State) :-
    monotonic_time(Now),
    server_self(Owner),
    catch(( process_begin(Command, Owner, Role, said(Name, Owner), Process),
            State = up(Process, Now, Wait) ),
          error(Formal, Context),
          ( First is max(0.1, Wait),
            down(When, First, error(Formal, Context), State) )).

down(asked, _, Answer, down(asked, none, Answer)).
down(always, Wait0, Answer, down(Time, Wait, Answer)) :-
    deadline(Wait0, Time),
    Wait is min(10, 2*Wait0).

%   A restarted helper first gets the state that it needs.

begin_again(Me, Wait, State) :-
    begin(Me, Wait, State),
    Me = owner(Name, _, _, _, _),
    forall(( State = up(_, _, _), again(Name, Request) ),
           ( json_text(Request, Line),
             write_line(State, Line) )).

%   Fail the open requests, and restart the process as its mode demands.

ended(Status, Me, Since, Wait, State) :-
    Me = owner(Name, _, When, _, _),
    answer_died(died(Status), Answer),
    debug(typhon(helper), '~p ended: ~p', [Name, Status]),
    (   unfit(Answer)
    ->  State = down(asked, none, Answer)
    ;   report_ended(When, Name, Status),
        again_when(When, Since, Wait, Wait1),
        again(Wait1, Me, Answer, State)
    ).

%   The process has reported that it lacks a prerequisite.  Then every request
%   gets this report as its answer.

unfit(said(Dict)) :-
    get_dict(again, Dict, false).

again(now, Me, _, State) :-
    !,
    begin_again(Me, 0.1, State).
again(Wait, owner(_, _, When, _, _), Answer, State) :-
    down(When, Wait, Answer, State).

%   again_when(+When, +Since, +Wait, -Wait1): the first restart is immediate,
%   and so is that of a process which has run for some time.

again_when(asked, _, _, none) :-
    !.
again_when(always, _, 0, now) :-
    !.
again_when(always, Since, Wait, Wait1) :-
    monotonic_time(Now),
    soon(Soon),
    (   Now-Since > Soon
    ->  Wait1 = now
    ;   Wait1 = Wait
    ).

report_ended(asked, _, _).
report_ended(always, Name, Status) :-
    print_message(warning, typhon(helper_ended(Name, Status))).

write_request(up(Process, _, _), Id, Caller, Line) :-
    answer_awaited(Id, Caller),
    process_write(Process, Line).
write_request(down(_, _, Answer), _, Caller, _) :-
    server_answer(Caller, Answer).

write_line(up(Process, _, _), Line) :-
    process_write(Process, Line).
write_line(down(_, _, _), _).           % no caller waits

stop(up(Process, _, _)) :-
    json_text(_{do:quit}, Line),
    process_write(Process, Line),
    process_end(Process),
    process_release(Process).
stop(down(_, _, _)).

prolog:message(typhon(helper_ended(Name, Status))) -->
    [ 'The helper ~p ended (~p), and is started again'-[Name, Status] ].

                /*******************************
                *           ANSWERS            *
                *******************************/

:- multifile
    handle_message/2.           % Name, Dict: an unsolicited message

:- dynamic
    awaited/3,                  % Id, Caller, Owner: written, not yet answered
    complaint/2.                % Owner, Dict: an error without a request

%!  request_line(+Request:dict, +Seconds, -Id, -Line:string) is det.
%
%   Line is Request with a new Id, and its time limit.

request_line(Request0, Seconds, Id, Line) :-
    flag(typhon_helper_request, Id, Id+1),
    put_dict(_{id:Id, timeout:Seconds}, Request0, Request),
    json_text(Request, Line).

%!  said(+Name, +Owner, +Dict) is det.
%
%   Handle Dict, a message of the helper Name of Owner.

said(_, Owner, Dict) :-
    get_dict(id, Dict, Id),
    integer(Id),
    !,
    retractall(complaint(Owner, _)),
    (   retract(awaited(Id, Caller, _))
    ->  answer_of(Dict, Answer),
        server_answer(Caller, Answer)
    ;   true                            % the caller has stopped waiting
    ).
said(Name, _, Dict) :-
    get_dict(event, Dict, _),
    !,
    ignore(handle_message(Name, Dict)).
said(_, Owner, Dict) :-
    get_dict(error, Dict, _),
    !,
    retractall(complaint(Owner, _)),
    assertz(complaint(Owner, Dict)).
said(_, _, _).

answer_of(Dict, ok(Reply)) :-
    get_dict(ok, Dict, Reply),
    !.
answer_of(Dict, said(Dict)).

%!  answer_awaited(+Id, +Caller) is det.
%!  answer_unwanted(+Id) is det.
%
%   Caller waits for the answer to the request Id, which the owner is about to
%   write; the caller of Id has stopped waiting.

answer_awaited(Id, Caller) :-
    server_self(Owner),
    assertz(awaited(Id, Caller, Owner)).

answer_unwanted(Id) :-
    retractall(awaited(Id, _, _)).

%   answer_all(+Answer) is det.
%   answer_died(+Answer0, -Answer) is det.
%
%   Give all open requests of the owner Answer.  In answer_died/2 it is the
%   error that the process reported before it ended, else Answer0.

answer_all(Answer) :-
    server_self(Owner),
    (   retract(awaited(_, Caller, Owner))
    ->  server_answer(Caller, Answer),
        answer_all(Answer)
    ;   true
    ).

answer_died(Answer0, Answer) :-
    server_self(Owner),
    (   retract(complaint(Owner, Dict))
    ->  Answer = said(Dict)
    ;   Answer = Answer0
    ),
    answer_all(Answer).
