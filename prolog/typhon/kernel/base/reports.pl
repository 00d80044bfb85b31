:- module(typhon_reports,
          [ report/4,                   % +Level, +Kind, +Group, +Message
            report/5,                   % +Level, +Kind, +Group, +Count,
                                        % +Message
            reports_due/0,
            reports_end/0
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(error_text, [abridged/3]).
:- use_module(monotonic, [monotonic_time/1]).

/** <module> Warnings that agents and peers can cause as often as they want

The first report of a kind in a second is printed.  Further ones are counted,
for each group of the kind, such as an agent or an address, and when the second
is over one message reports their numbers.  So a flood does not fill the log,
and does not go unnoticed.

Time passes by the monotonic clock.  The hook wakes/1 calls reports_due/0
when a second is over; without it the next report does that, or reports_end/0
when the endpoint or the process ends.

*Threading*: any thread; a mutex protects the tables.  Nothing is printed while
it is held.
*/

:- multifile
    wakes/1,                    % Stamp: reports_due/0 will be called then
    summary/3,                  % Kind, Groups, Message: Groups are Count-Group,
                                % the largest first
    prolog:message//1.

:- dynamic
    burst/2,                    % Kind, Until
    tally/4.                    % Kind, Group, Level, Count: not yet reported

%   Kinds and groups may be named by agents: further ones are counted together.

most_kinds(64).
most_groups(16).

%!  report(+Level, +Kind, +Group, +Message) is det.
%!  report(+Level, +Kind, +Group, +Count, +Message) is det.
%
%   Print Message, as print_message/2 does, unless one of this Kind was printed
%   within a second; then count it, as Count reports of Group.  Kind and
%   Group are ground.

report(Level, Kind, Group, Message) :-
    report(Level, Kind, Group, 1, Message).

report(Level, Kind, Group, Count, Message) :-
    monotonic_time(Now),
    conclude_all(Now, 1),
    locked(note(Level, Kind, Group, Count, Now, How)),
    (   How = first(Until)
    ->  ignore(wakes(Until)),
        print_message(Level, Message)
    ;   true
    ).

:- meta_predicate locked(0).

locked(Goal) :-
    sig_atomic(with_mutex(typhon_reports, Goal)).

note(Level, Kind0, Group, Count, Now, How) :-
    bounded(Kind0, Kind),
    (   burst(Kind, _)
    ->  add(Kind, Group, Level, Count),
        How = counted
    ;   begin(Kind, Now, Until),
        How = first(Until)
    ).

bounded(Kind, Kind) :-
    burst(Kind, _),
    !.
bounded(Kind0, Kind) :-
    aggregate_all(count, burst(_, _), Count),
    most_kinds(Most),
    ( Count < Most -> Kind = Kind0 ; Kind = others ).

begin(Kind, Now, Until) :-
    Until is Now+1,
    assertz(burst(Kind, Until)).

add(Kind, Group, Level, Count) :-
    retract(tally(Kind, Group, Level, Count0)),
    !,
    Count1 is Count0+Count,
    assertz(tally(Kind, Group, Level, Count1)).
add(Kind, Group, Level, Count) :-
    aggregate_all(count, tally(Kind, _, _, _), Groups),
    most_groups(Most),
    (   ( Groups < Most ; Group == others )
    ->  assertz(tally(Kind, Group, Level, Count))
    ;   add(Kind, others, Level, Count)
    ).

%!  reports_due is det.
%!  reports_end is det.
%
%   Report what was counted, if the second of its kind is over; report all.

reports_due :-
    monotonic_time(Now),
    conclude_all(Now, 0).

reports_end :-
    conclude_all(inf, 0).

:- at_halt(reports_end).

conclude_all(Now, Grace) :-
    forall(( burst(Kind, Until), Until+Grace =< Now ),
           conclude(Kind, Until, Now)).

conclude(Kind, Until, Now) :-
    locked(taken(Kind, Until, Tallies)),
    (   Tallies == []
    ->  true
    ;   wake_again(Kind, Now),
        summarize(Kind, Tallies)
    ).

taken(Kind, Until, Tallies) :-
    (   retract(burst(Kind, Until))
    ->  findall(tally(Group, Level, Count), tally(Kind, Group, Level, Count),
                Tallies),
        retractall(tally(Kind, _, _, _))
    ;   Tallies = []                    % another thread reports them
    ).

%   What is still counted belongs to a burst that goes on.

wake_again(_, inf) :-
    !.
wake_again(Kind, Now) :-
    locked(( burst(Kind, Until) -> true ; begin(Kind, Now, Until) )),
    ignore(wakes(Until)).

summarize(Kind, Tallies) :-
    findall(Count-Group, member(tally(Group, _, Count), Tallies), Groups0),
    sort(1, @>=, Groups0, Groups),
    level(Tallies, Level),
    (   summary(Kind, Groups, Message)
    ->  true
    ;   Message = typhon(more(Kind, Groups))
    ),
    print_message(Level, Message).

level(Tallies, Level) :-
    member(Level, [error,warning,informational]),
    memberchk(tally(_, Level, _), Tallies),
    !.

prolog:message(typhon(more(Kind, Groups))) -->
    { aggregate_all(sum(Count), member(Count-_, Groups), Sum),
      functor(Kind, Text, _)
    },
    [ '... and ~D more within a second (~w)'-[Sum,Text] ],
    groups(Groups).

groups([]) -->
    [].
groups([Count-Group|Groups]) -->
    { shown(Group, Text) },
    [ nl, '  ~D: ~w'-[Count,Text] ],
    groups(Groups).

%   A name may have been chosen by an agent or a peer.

shown(Group, Text) :-
    abridged(Group, 200, Text0),
    (   string_code(_, Text0, Code),
        \+ code_type(Code, graph),
        Code =\= 0'\s
    ->  Text = 'a name that cannot be shown'
    ;   Text = Text0
    ).
