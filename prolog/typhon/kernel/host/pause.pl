:- module(typhon_pause,
          [ still/0,
            still_begin/0,
            still_end/1,                % -Agents
            still_keeps/1               % +Agent
          ]).

/** <module> A process that comes to rest, in real time

While it is still no alarm goes off, and no agent begins a turn: those whose
turn has come are kept until that is over.

*Threading*: any thread; the thread that begins it ends it.
*/

:- dynamic
    still/0,
    kept/1.                             % Agent: its turn has come

%!  still is semidet.
%!  still_begin is det.
%!  still_end(-Agents:list) is det.
%
%   Agents are those that were kept, whose turn it is.

still_begin :-
    with_mutex(typhon_pause,
               (   still
               ->  true
               ;   assertz(still)
               )).

still_end(Agents) :-
    with_mutex(typhon_pause,
               ( retractall(still),
                 findall(Agent, kept(Agent), Agents),
                 retractall(kept(_)) )).

%!  still_keeps(+Agent) is semidet.
%
%   The turn of Agent comes later.

still_keeps(Agent) :-
    still,
    with_mutex(typhon_pause, ( still, assertz(kept(Agent)) )).
