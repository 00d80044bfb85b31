:- module(study_estimate,
          [ longest_first/2,            % +Runs, -Sorted
            estimate_begin/1,           % +Runs
            estimate_ended/2,           % +Run, +Seconds
            estimate/4                  % +Busy, +Jobs, -Share, -Seconds
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_values/2]).
:- use_module(costs, [cost/2]).
:- use_module(studies, [study_title/3]).

/** <module> How long the runs of a session will take

cost/2 has the seconds of a run of each study on one computer, so that the time
left can be told before any run has ended.  Runs that end show how much faster or
slower this computer is, and how long each case takes.

*Threading*: the main thread.
*/

:- dynamic
    known/0,                    % cost/2 has one of the runs
    guess/2,                    % Key, Seconds: at the speed of cost/2
    left/2,                     % Key, Count: of runs that have not ended
    took/3.                     % Key, Count, Seconds: of runs that have

%!  longest_first(+Runs, -Sorted) is det.
%
%   Runs are in the order of their seeds, and remain so.  Of one seed the run
%   that usually takes longest is first, so that no long run is left for a
%   single processor in the end.

longest_first(Runs, Sorted) :-
    findall(Seed-(Seconds-Run),
            ( member(Run, Runs), Run = run(_, _, Seed), guess_of(Run, Seconds) ),
            Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(Of,
            ( member(_-Group, Groups),
              sort(1, @>=, Group, Falling),
              pairs_values(Falling, Of) ),
            Lists),
    append(Lists, Sorted).

%!  estimate_begin(+Runs) is det.
%!  estimate_ended(+Run, +Seconds) is det.
%
%   Runs are to be made; Run, one of them, has ended after Seconds.  Others are
%   ignored.

estimate_begin(Runs) :-
    retractall(known),
    retractall(guess(_, _)),
    retractall(left(_, _)),
    retractall(took(_, _, _)),
    forall(member(Run, Runs), to_make(Run)),
    (   member(run(Study, _, _), Runs),
        study_title(Study, Name, _),
        cost(Name, _)
    ->  assertz(known)
    ;   true
    ).

to_make(Run) :-
    key(Run, Key),
    (   retract(left(Key, Count0))
    ->  Count is Count0 + 1
    ;   Count = 1,
        guess_of(Run, Seconds),
        assertz(guess(Key, Seconds))
    ),
    assertz(left(Key, Count)).

estimate_ended(Run, Seconds) :-
    key(Run, Key),
    retract(left(Key, Count0)),
    !,
    Count is Count0 - 1,
    assertz(left(Key, Count)),
    ( retract(took(Key, Ended0, Sum0)) -> true ; Ended0 = 0, Sum0 = 0 ),
    Ended is Ended0 + 1,
    Sum is Sum0 + Seconds,
    assertz(took(Key, Ended, Sum)).
estimate_ended(_, _).

key(run(Study, Case, Seed), Key) :-
    ( integer(Seed) -> Kind = run ; Kind = replay ),
    term_hash(Kind-Study-Case, Key).

%!  estimate(+Busy, +Jobs, -Share, -Seconds) is semidet.
%
%   Share, from 0 to 1, of the work is done, and the rest takes some Seconds with
%   as many workers as Jobs.  Busy are pairs of a run that is being made and the
%   seconds since it began.  Fails if nothing is known yet.

estimate(Busy, Jobs, Share, Seconds) :-
    speed(Speed),
    aggregate_all(sum(Took), took(_, _, Took), Done),
    aggregate_all(sum(Count*Each),
                  ( left(Key, Count), Count > 0, expected(Key, Speed, Each) ),
                  Left0),
    findall(Since-Rest, ( member(Run-Since0, Busy),
                          under_way(Run, Since0, Speed, Since, Rest) ),
            Pairs),
    aggregate_all(sum(Since), member(Since-_, Pairs), Begun),
    aggregate_all(max(Rest), member(_-Rest, [0-0|Pairs]), Longest),
    Left is Left0 - Begun,
    Share is (Done + Begun)/max(0.001, Done + Begun + Left),
    Seconds is max(Left/Jobs, Longest).

%   A run that has taken longer than expected is about to end.

under_way(Run, Since0, Speed, Since, Rest) :-
    key(Run, Key),
    expected(Key, Speed, Seconds),
    Since is min(Since0, Seconds),
    Rest is Seconds - Since.

expected(Key, _, Seconds) :-
    took(Key, Count, Sum),
    !,
    Seconds is Sum/Count.
expected(Key, Speed, Seconds) :-
    guess(Key, Guess),
    Seconds is Guess*Speed.

%   speed(-Speed): seconds here for each second of cost/2.

speed(Speed) :-
    took(_, _, _),
    !,
    aggregate_all(sum(Sum)-sum(Count*Guess),
                  ( took(Key, Count, Sum), guess(Key, Guess) ),
                  Here-There),
    Speed is Here/There.
speed(1) :-
    known.

%   Studies that cost/2 does not have are taken to have equal runs.

guess_of(run(Study, _, _), Seconds) :-
    study_title(Study, Name, _),
    cost(Name, Seconds),
    !.
guess_of(_, 1).
