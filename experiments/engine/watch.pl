:- module(study_watch,
          [ watching/4                  % +Log, +What, +Total, :Goal
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../../prolog/typhon/kernel/base/monotonic', [wait_within/2]).
:- use_module(follow, [new_lines/4]).
:- use_module(progress, [progress/3, progress_done/1]).

/** <module> Progress of a run

*Threading*: a thread reads the log while the caller works.
*/

:- meta_predicate
    watching(+, +, +, 0).

%!  watching(+Log, +What, +Total, :Goal) is semidet.
%
%   Calls Goal once.  Meanwhile user_error shows the number of events What in
%   the file Log, out of Total.

watching(Log, What, Total, Goal) :-
    setup_call_cleanup(
        thread_create(count_events(Log, What, Total, 0, 0), Thread,
                      [alias(study_onlooker)]),
        once(Goal),
        ( thread_send_message(Thread, stop),
          thread_join(Thread, _),
          progress_done(user_error) )).

count_events(Log, What, Total, Position0, Count0) :-
    new_lines(Log, Position0, Position, Lines),
    aggregate_all(count, ( member(Line, Lines), is_event(Line, What) ), New),
    Count is Count0 + New,
    Shown is min(Count, Total),
    Share is Shown/max(1, Total),
    format(atom(Text), '~d/~d events', [Shown, Total]),
    progress(user_error, Share, Text),
    thread_self(Me),
    (   wait_within(0.2, thread_get_message(Me, stop))
    ->  true
    ;   count_events(Log, What, Total, Position, Count)
    ).

is_event(Line, What) :-
    catch(term_string(event(_, _, _, Event), Line), error(_, _), fail),
    subsumes_term(What, Event).
