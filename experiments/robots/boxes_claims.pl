:- module(robots_boxes_claims,
          [ boxes_claims/3              % +Script, +Result, -Claims
          ]).
:- use_module(boxes_metrics, [together/3]).
:- use_module(boxes_script, [script_jobs/2]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists),
              [append/2, member/2, memberchk/2, subtract/3]).

/** <module> Do the statements of thesis section 7.7 hold of a run?

*Threading*: pure.
*/

%!  boxes_claims(+Script, +Result, -Claims) is det.
%
%   The statements of section 7.7, judged by a Result of Script.  Where two
%   boxes need more robots together than there are, one of them must wait
%   for the other.

boxes_claims(Script, Result, Claims) :-
    findall(claim(Text, Held, Found),
            ( statement(Text, Script, Result, Goal, Found),
              held(Goal, Held) ),
            Claims).

:- meta_predicate held(0, -).

held(Goal, Held) :-
    (   call(Goal)
    ->  Held = true
    ;   Held = false
    ).

statement('every box is pushed to its destination', Script, Result,
          Left == [], Found) :-
    names(Script, Names),
    memberchk(pushed(Pushed), Result),
    subtract(Names, Pushed, Left),
    counted(Names, Left, Found).
statement('every job is completed', Script, Result, Left == [], Found) :-
    names(Script, Names),
    memberchk(jobs(Jobs), Result),
    findall(Name,
            ( member(job(Name, _, _, Time, _, _), Jobs), number(Time) ),
            Done),
    subtract(Names, Done, Left),
    counted(Names, Left, Found).
statement('of two jobs that contend one backs off, and waits', Script,
          Result, Count =:= All, Found) :-
    findall(A-B, contend(Script, A, B), Pairs),
    Pairs = [_|_],
    memberchk(jobs(Jobs), Result),
    exclude(collide(Jobs), Pairs, Good),
    length(Pairs, All),
    length(Good, Count),
    format(atom(Found), '~d of ~d pairs', [Count, All]).
statement('two jobs for which there are enough robots go on side by side',
          Script, Result, Count =:= All, Found) :-
    findall(A-B, ( together_in(Script, A, B), \+ contend(Script, A, B) ),
            Pairs),
    Pairs = [_|_],
    memberchk(jobs(Jobs), Result),
    findall(A-B, ( member(A-B, Pairs), together(Jobs, A, B) ), Good),
    length(Pairs, All),
    length(Good, Count),
    format(atom(Found), '~d of ~d pairs', [Count, All]).
statement('robots that join while others push are used', Script, Result,
          Idle == [], Found) :-
    Script = script(First, _),
    memberchk(hosts(Hosts), Result),
    length(Old, First),
    append([Old, New], Hosts),
    New = [_|_],
    memberchk(holdings(Holdings), Result),
    findall(Host, ( member(Host, New), \+ worked(Holdings, Host) ), Idle),
    counted(New, Idle, Found).
statement('in the end all robots are in the dock', _, Result, Metres < 0.1,
          Found) :-
    memberchk(from_dock(Metres), Result),
    format(atom(Found), 'at most ~2f m from where they were', [Metres]).

names(Script, Names) :-
    script_jobs(Script, Jobs),
    findall(Name, member(job(Name, _, _), Jobs), Names).

counted(All, Left, Found) :-
    length(All, Total),
    length(Left, Missing),
    Count is Total - Missing,
    format(atom(Found), '~d of ~d', [Count, Total]).

together_in(script(_, Phases), A, B) :-
    member(phase([job(A, _, _), job(B, _, _)], _), Phases).

%   contend(+Script, -A, -B): the two jobs of a phase, for which there are
%   not enough robots when it begins.

contend(script(Robots, Phases), A, B) :-
    contend(Phases, Robots, A, B).

contend([phase([job(A, _, Needs1), job(B, _, Needs2)], _)|_], Robots, A,
        B) :-
    Needs1 + Needs2 > Robots.
contend([phase(_, Joining)|Phases], Robots0, A, B) :-
    Robots is Robots0 + Joining,
    contend(Phases, Robots, A, B).

collide(Jobs, A-B) :-
    together(Jobs, A, B).
collide(Jobs, A-B) :-
    \+ ( member(Name, [A, B]),
         memberchk(job(Name, _, _, _, _, [_|_]), Jobs) ).

worked(Holdings, Host) :-
    member(holding(Host, _, _, Start, _), Holdings),
    number(Start),
    !.
