:- module(typhon_waiting,
          [ deadline/2,                 % +Seconds, -Deadline
            message_before/3            % +Queue, ?Message, +Deadline
          ]).

/** <module> Waits that end

*Threading*: any thread, but none that runs a cleanup handler, see
typhon_own_thread.
*/

%!  deadline(+Seconds, -Deadline) is det.
%
%   The time stamp that is so many seconds ahead.

deadline(Seconds, Deadline) :-
    get_time(Now),
    Deadline is Now + Seconds.

%!  message_before(+Queue, ?Message, +Deadline) is semidet.
%
%   Take Message from Queue; fails when there is none before Deadline.

message_before(Queue, Message, Deadline) :-
    get_time(Now),
    Wait is max(0, Deadline - Now),
    thread_get_message(Queue, Message, [timeout(Wait)]).
