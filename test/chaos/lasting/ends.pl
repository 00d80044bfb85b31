:- module(lasting_ends,
          [ agents_end/3                % +Agents, +Deadline, -Ends
          ]).

/** <module> The ends of agents whose processes die

*Threading*: the thread that asks waits.
*/

:- use_module('../../../prolog/typhon').
:- use_module(library(lists), [member/2]).

%!  agents_end(+Agents, +Deadline, -Ends) is det.
%
%   Ends are Agent-End, as of agent_join/3, or `late` where there is none at
%   Deadline.

agents_end(Agents, Deadline, Ends) :-
    findall(Agent-End, ( member(Agent, Agents), ends(Agent, Deadline, End) ),
            Ends).

%   The queried process may be dead at the moment.

ends(Agent, Deadline, End) :-
    get_time(Now),
    Left is Deadline-Now,
    (   Left =< 0
    ->  End = late
    ;   Some is min(2, Left),
        catch(agent_join(Agent, End0, Some), error(Formal, _),
              End0 = error(Formal)),
        settled_end(End0, Agent, Deadline, End)
    ).

settled_end(End, Agent, Deadline, End1) :-
    ( End == timeout ; End = error(_) ; End == unknown ),
    !,
    thread_self(Me),
    \+ thread_get_message(Me, '$never', [timeout(0.1)]),
    ends(Agent, Deadline, End1).
settled_end(End, _, _, End).
