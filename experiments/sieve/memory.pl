:- module(sieve_memory,
          [ memory_case/2,              % ?Case, -Settings
            draw_memory/3,              % +Directory, +Subtitle, +CaseRuns
            memory_claims/2             % +CaseRuns, -Claims
          ]).
:- use_module('../lib/chart', [draw_chart/3, median/2]).
:- use_module(rounds, [plan/2, plan_rounds/2, population/3, waits/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [member/2, nth0/3, nth1/3, numlist/3, sum_list/2]).

/** <module> Memory cells: the second response to an antigen

The antigen of the first rounds comes back after others have attacked for
so long that the clones of its antibodies have died.

*Threading*: no state; any thread.
*/

%!  memory_case(?Case, -Settings) is nondet.
%
%   With memory cells and without.  Hosts call three times before they help
%   themselves, so that the response is that of agents where there are any.

memory_case('without memory cells', [calls-3, memory_cells-0]).
memory_case('with memory cells',
            [calls-3, memory_cells-1, memory_wins-2]).

returning([0,0,0,0,0]).

%   seconds(+Rounds, +R, -Mean): how long a host waited on average.

seconds(Rounds, R, Mean) :-
    plan(memory, Plan),
    plan_rounds(Plan, Antigens),
    nth1(R, Antigens, [Antigen]),
    waits(Rounds, R, Antigen, Waits),
    length(Waits, Count),
    Count > 0,
    sum_list(Waits, Sum),
    Mean is Sum/Count.

%   able(+Rounds, +R, -Count): agents that can neutralize the antigen that
%   returns.

able(Rounds, R, Count) :-
    population(Rounds, R, Population),
    returning(Antigen),
    aggregate_all(sum(N),
                  ( member(N-Kind, Population),
                    aggregate_all(count, ( nth1(I, Kind, Bit),
                                           nth1(I, Antigen, Other),
                                           Bit =\= Other ), Psi),
                    Psi >= 4 ),
                  Count).

%!  draw_memory(+Directory, +Subtitle, +CaseRuns) is det.
%
%   Write Directory/sieve-memory.svg and .png.

draw_memory(Directory, Subtitle, CaseRuns) :-
    CaseRuns = [_-[_-Rounds|_]|_],
    length(Rounds, Last),
    numlist(1, Last, Ticks),
    series(CaseRuns, Last, seconds, Seconds),
    series(CaseRuns, Last, able, Able),
    draw_chart(Directory, 'sieve-memory',
               [ title('The antigen of rounds 1 to 5 returns in round 14'),
                 subtitle(Subtitle), x('round of attacks'), ticks(Ticks),
                 panels([ panel('Time until a host under attack was served',
                                's', Seconds),
                          panel('Agents that can neutralize that antigen',
                                agents, Able) ])
               ]).

series(CaseRuns, Last, What, Series) :-
    findall(series(Case, Index, Points, none),
            ( nth0(Index, CaseRuns, Case-Runs),
              findall(R-Values,
                      ( between(1, Last, R),
                        findall(V, ( member(_-Rounds, Runs),
                                     call(What, Rounds, R, V) ),
                                Values),
                        median(Values, _) ),
                      Points)
            ),
            Series).

%!  memory_claims(+CaseRuns, -Claims) is det.
%
%   Claims compare round 14, when the antigen returns, with round 1, and
%   the two cases, by the median of the runs.

memory_claims(CaseRuns, Claims) :-
    CaseRuns = [_-Without, _-With],
    middle(With, 1, First),
    middle(With, 14, Second),
    middle(Without, 14, Plain),
    findall(claim(Text, Held, Found),
            ( compared(Text, First, Plain, Other),
              ( Second < Other -> Held = true ; Held = false ),
              format(atom(Found), '~2f s, ~2f s', [Second, Other])
            ),
            Claims).

compared('with memory cells the second response is faster than the first',
         First, _, First).
compared('and faster than the second one without them', _, Plain, Plain).

middle(Runs, R, Median) :-
    findall(Mean, ( member(_-Rounds, Runs), seconds(Rounds, R, Mean) ),
            Means),
    median(Means, Median).
