:- module(test_event_log,
          [ logged/2                    % +File, -Events
          ]).
:- use_module('../../experiments/lib/follow', [new_lines/4]).
:- use_module(library(lists), [member/2]).

/** <module> The event log of a network that is running

*Threading*: any thread.
*/

%!  logged(+File, -Events:list) is det.
%
%   What was logged so far, in order, event(Time, Host, Agent, What).

logged(File, Events) :-
    new_lines(File, 0, _, Lines),
    findall(Event,
            ( member(Line, Lines),
              catch(term_string(Event, Line), error(syntax_error(_), _),
                    fail),
              Event = event(_, _, _, _) ),
            Events).
