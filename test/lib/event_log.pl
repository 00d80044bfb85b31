:- module(test_event_log,
          [ logged/2,                   % +File, -Events
            stopped_executing/4         % +Args, +File, +Signal, -Status
          ]).
:- use_module(common, [wait_for_end/3, wait_until/2, with_swipl/5]).
:- use_module('../../experiments/engine/follow', [new_lines/4]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(process), [process_kill/2]).

/** <module> The event log of a network that is running

*Threading*: any thread.
*/

%!  logged(+File, -Events:list) is det.
%
%   The events so far, in order, event(Time, Host, Agent, What).

logged(File, Events) :-
    new_lines(File, 0, _, Lines),
    findall(Event,
            ( member(Line, Lines),
              catch(term_string(Event, Line), error(syntax_error(_), _),
                    fail),
              Event = event(_, _, _, _) ),
            Events).

%!  stopped_executing(+Args, +File, +Signal, -Status) is det.
%
%   A `swipl Args` that writes the log File, or one that this is a pattern of,
%   gets Signal when a task has begun.
%   Status is as of wait_for_end/3.

stopped_executing(Args, File, Signal, Status) :-
    with_swipl(Args, Pid, _, _,
               ( wait_until(executing(File), 60),
                 process_kill(Pid, Signal),
                 wait_for_end(Pid, 40, Status)
               )).

executing(Pattern) :-
    expand_file_name(Pattern, Files),
    member(File, Files),
    logged(File, Events),
    memberchk(event(_, _, _, executing(_, _)), Events).
