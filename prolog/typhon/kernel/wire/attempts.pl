:- module(typhon_attempts,
          [ attempt/4,                  % ?Address, ?State, -Pause, -Since
            attempt_want/1,             % +Address
            attempt_begun/3,            % +Address, +Thread, +Asked
            attempt_asked/2,            % +State, -Asked
            attempt_greeted/1,          % +Thread
            attempt_pause/3,            % +Address, +Pause, +Since
            attempt_end/1,              % ?Address
            attempt_over/3,             % +Address, +Since, +Formal
            attempt_next/2,             % +Me, -Address
            attempt_due/1,              % -Time
            attempts_due/1              % -Due
          ]).

/** <module> Attempts to connect, and their times

Each wanted address has one attempt: it is queued, is being made, or pauses
until it is made again. connection_manager.pl handles its result.

*Threading*: the thread of the connection manager owns the table.
*/

:- use_module(library(lists), [min_member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(peer_cache, [peer_expected/1]).
:- use_module(session, [session/2]).

:- setting(typhon_connection_manager:connect_time, number, 5,
           "Seconds until a peer is reported as unreachable").
:- setting(typhon_connection_manager:return_time, number, 30,
           "Seconds until a restarting peer is reported as unreachable").

:- dynamic
    attempt/4.                          % Address, State, Pause, Since

%!  attempt(?Address, ?State, -Pause, -Since) is nondet.
%
%   State is `queued`, trying(Thread, Start, Asked) or pausing(Until, Asked):
%   requests from before the last try have a number below Asked. Pause is the
%   next pause. Callers have waited since the time Since, `unset` before the
%   first try begins, `none` if no caller waits.

first_pause(0.02).
longest_pause(2).
longest_pause_of_expected(0.2).

%   With many processes all may be busy at once, as at their start: then a peer
%   may be silent for longer before it counts as unreachable.

patience(Seconds) :-
    setting(typhon_connection_manager:connect_time, Seconds0),
    predicate_property(attempt(_, _, _, _), number_of_clauses(Attempts)),
    predicate_property(session(_, _), number_of_clauses(Sessions)),
    Seconds is Seconds0*min(4, 1+(Attempts+Sessions)//16).

		 /*******************************
		 *            STATES            *
		 *******************************/

%!  attempt_want(+Address) is det.
%
%   A caller waits for Address. Later callers share its attempt.

attempt_want(Address) :-
    attempt(Address, _, _, Since),
    Since \== none,
    !.
attempt_want(Address) :-
    first_pause(Pause),
    (   attempt(Address, Trying, _, _),
        Trying = trying(_, _, _)
    ->  get_time(Now),
        set(Address, Trying, Pause, Now)
    ;   set(Address, queued, Pause, unset)
    ).

%!  attempt_begun(+Address, +Thread, +Asked) is det.
%
%   Thread tries to reach Address. The time of waiting callers starts with the
%   first try.

attempt_begun(Address, Thread, Asked) :-
    attempt(Address, _, Pause, Since0),
    get_time(Now),
    (   Since0 == unset
    ->  Since = Now
    ;   Since = Since0
    ),
    set(Address, trying(Thread, Now, Asked), Pause, Since).

%!  attempt_asked(+State, -Asked) is det.
%
%   Asked is that of State, see attempt/4.

attempt_asked(queued, 0).
attempt_asked(trying(_, _, Asked), Asked).
attempt_asked(pausing(_, Asked), Asked).

%!  attempt_greeted(+Thread) is det.
%
%   The peer has answered the attempt of Thread: it exists, and is slow, as all
%   are when many start at once.  The time starts again, unless many attempts
%   have failed.

attempt_greeted(Thread) :-
    (   attempt(Address, trying(Thread, _, Asked), Pause, Since),
        number(Since),
        longest_pause(Longest),
        Pause < Longest
    ->  get_time(Now),
        set(Address, trying(Thread, Now, Asked), Pause, Now)
    ;   true
    ).

%!  attempt_pause(+Address, +Pause, +Since) is det.
%
%   Try again after about Pause seconds, and the next time after twice as many,
%   but before the deadline of a caller that has waited since Since.

attempt_pause(Address, Pause, Since) :-
    get_time(Now),
    Some is float_fractional_part(Now*1000),    % library(random) is slow
    Until0 is Now+Pause*(0.5+Some),             % to begin
    (   number(Since)
    ->  deadline(Address, Since, Deadline),
        Until is min(Deadline, Until0)
    ;   Until = Until0
    ),
    longest_pause(Address, Longest),
    Longer is min(Longest, 2*Pause),
    (   attempt(Address, State, _, _)
    ->  attempt_asked(State, Asked)
    ;   Asked = 0
    ),
    set(Address, pausing(Until, Asked), Longer, Since).

longest_pause(Address, Longest) :-
    (   peer_expected(Address)
    ->  longest_pause_of_expected(Longest)
    ;   longest_pause(Longest)
    ).

set(Address, State, Pause, Since) :-
    retractall(attempt(Address, _, _, _)),
    assertz(attempt(Address, State, Pause, Since)).

%!  attempt_end(?Address) is det.
%
%   Delete the attempt to connect to Address.

attempt_end(Address) :-
    retractall(attempt(Address, _, _, _)).

		 /*******************************
		 *             ORDER            *
		 *******************************/

%!  attempt_next(+Me, -Address) is semidet.
%
%   Address is tried next; Me is the hello of this process. If many processes
%   start at once all would be late together, and both processes of each pair
%   would connect. So few attempts are made at a time, by each process in an
%   order of its own: most peers connect by themselves before it is their turn.

attempt_next(Me, Address) :-
    attempt(_, queued, _, _),
    \+ crowded,
    !,
    findall(Hash-Queued,
            ( attempt(Queued, queued, _, _),
              term_hash(Queued-Me, Hash) ),
            Order),
    min_member(_-Address, Order).

crowd(4).
crowd_seconds(2).

crowded :-
    crowd(Many),
    findall(x, young(_), Young),
    length(Young, Count),
    Count >= Many.

%   young(-Until): there is an attempt that has begun recently, and may soon
%   end.

young(Until) :-
    crowd_seconds(Seconds),
    get_time(Now),
    attempt(_, trying(_, Start, _), _, _),
    Until is Start+Seconds,
    Until > Now.

		 /*******************************
		 *           DEADLINES          *
		 *******************************/

%!  attempt_over(+Address, +Since, +Formal) is semidet.
%
%   After the failure Formal, `late` if there was no answer, the caller that has
%   waited for Address since Since gets a result: its time is over, or another
%   attempt would fail, too.

attempt_over(Address, Since, Formal) :-
    number(Since),
    (   \+ may_pass(Formal),
        \+ soon_there(Formal, Address)
    ->  true
    ;   deadline(Address, Since, Deadline),
        get_time(Now),
        Deadline =< Now
    ).

%   The process is being restarted.

soon_there(socket_error(econnrefused, _), Address) :-
    peer_expected(Address).

may_pass(late).
may_pass(ended).                        % replaced by another connection
may_pass(session_closed).
may_pass(timeout_error(_, _)).
may_pass(resource_error(_)).
may_pass(io_error(_, _)).
may_pass(syntax_error(end_of_file)).
may_pass(socket_error(Code, _)) :-
    memberchk(Code, [ econnreset, econnaborted, epipe, etimedout, eagain,
                      eai_again, eintr, emfile, enfile, enobufs, enomem,
                      eaddrnotavail ]).

deadline(Address, Since, Deadline) :-
    (   peer_expected(Address)
    ->  setting(typhon_connection_manager:return_time, Seconds)
    ;   patience(Seconds)
    ),
    Deadline is Since+Seconds.

%!  attempt_due(-Time) is nondet.
%
%   At Time the state of some attempt must change. A silent attempt ends in time
%   for another one, because its connection may be dead.

attempt_due(Time) :-
    attempt(Address, State, _, Since),
    due(State, Address, Since, Time).

due(pausing(Until, _), _, _, Until).
due(queued, _, _, Until) :-
    young(Until).
due(trying(_, Start, _), Address, Since, Until) :-
    patience(Seconds),
    Until0 is Start+0.6*Seconds,
    (   number(Since)
    ->  deadline(Address, Since, Deadline),
        Until is min(Until0, Deadline)
    ;   Until = Until0
    ).

%!  attempts_due(-Due) is det.
%
%   Due are the attempts that have tried or paused for long enough,
%   Address-State.

attempts_due(Due) :-
    get_time(Now),
    findall(Address-State,
            ( attempt(Address, State, _, Since),
              State \== queued,
              due(State, Address, Since, Until),
              Until =< Now ),
            Due).
