:- module(typhon_failed_processes,
          [ process_suspect/1           % +Peer
          ]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_peer/2,
                endpoint_reply/2, endpoint_request/4 ]).
:- use_module('../../kernel/host', [alarm_in/3, scheduler_call/1]).

/** <module> Detection of processes that have failed

A broken connection may be restored.  So a request is sent to the process, which
makes the endpoint try to reach it, and its state is checked until there is a
connection again, or the process is known to be gone: nothing listens at its
address, it closed the connection orderly, or another process is at its address.
A process that keeps a journal is not taken to be gone, as it may be restarted.

*Threading*: the hook detection_needed/0 is called in threads of connections,
process_failed/1 in a worker.
*/

:- multifile
    detection_needed/0,         % a monitor needs detection
    process_failed/1,           % Peer
    typhon_endpoint:connection/2,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2.

:- dynamic detection_needed/0.

first_pause(0.1).
longest_pause(5).

typhon_endpoint:connection(Peer, down) :-
    (   detection_needed,
        \+ endpoint_address(Peer)
    ->  process_suspect(Peer)
    ;   true
    ).
typhon_endpoint:connection(_, up).

%!  process_suspect(+Peer) is det.
%
%   The connection to Peer has broken: call process_failed(Peer) when the
%   process is known to be gone.

process_suspect(Peer) :-
    process_of(Peer, Process),
    endpoint_request(Peer, monitor, alive,
                     typhon_failed_processes:ignore_answer),
    first_pause(Pause),
    alarm_in(Pause, Peer, gone(Process, Pause)).

process_of(Peer, Process) :-
    (   endpoint_peer(Peer, process(Process0))
    ->  Process = Process0
    ;   Process = none
    ).

typhon_endpoint:requested(monitor, alive, _, ReplyTo) :-
    endpoint_reply(ReplyTo, yes).

:- public ignore_answer/1, report_failed/1.

ignore_answer(_).

typhon_scheduler:fire(Peer, gone(Process, Pause)) :-
    !,
    (   \+ detection_needed
    ->  true
    ;   has_failed(Peer, Process)
    ->  scheduler_call(typhon_failed_processes:report_failed(Peer))
    ;   endpoint_peer(Peer, state(up))
    ->  true
    ;   longest_pause(Longest),
        Next is min(Longest, 2*Pause),
        alarm_in(Next, Peer, gone(Process, Next))
    ).

has_failed(Peer, _) :-
    endpoint_gone(Peer),
    !.
has_failed(Peer, Process) :-
    process_of(Peer, Now),
    Now \== Process.

report_failed(Peer) :-
    forall(process_failed(Peer), true).
