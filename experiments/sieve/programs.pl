:- module(sieve_programs,
          [ draw_programs/3,            % +Directory, +Subtitle, +Runs
            programs_claims/2           % +Runs, -Claims
          ]).
:- use_module('../../prolog/typhon/program/paths', []).
:- use_module('../../prolog/typhon/program/programs', [payload_load/2]).
:- use_module('../lib/chart', [draw_chart/3]).
:- use_module(rounds, [plan/2, population/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [max_list/2, member/2, nth1/3, numlist/3, sum_list/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Programs in the sieve: which are left, and how good they are

The antibodies are programs that steer a robot round obstacles, the payload
sieve/maze.

*Threading*: no state; any thread.
*/

%   The payload in a module of its own, as an agent has it.

:- dynamic maze:feedback/3.

:- initialization(load_maze).

load_maze :-
    payload_load(payloads(sieve/maze), payload(_, PIs, Clauses)),
    forall(member(PI, PIs), dynamic(maze:PI)),
    forall(member(Clause, Clauses), assertz(maze:Clause)).

%   score(+How, +Rounds, +R, -Mean): of the programs that met the antigens of
%   a round, drawn at random (`generated`) or brought by agents (`served`):
%   31, less the steps beyond the shortest way, 0 if not at the goal.

score(How, Rounds, R, Mean) :-
    nth1(R, Rounds, round(Events)),
    findall(Xi,
            ( member(Event, Events),
              Event =.. [How, Antigen, Program, _],
              maze:feedback(Antigen, Program, Xi) ),
            Xis),
    mean(Xis, Mean).

mean(Numbers, Mean) :-
    Numbers = [_|_],
    sum_list(Numbers, Sum),
    length(Numbers, Count),
    Mean is Sum/Count.

%   able(+Rounds, +R, -Share): of the agents that there are, how many carry a
%   program that comes to the goal of some obstacle of the plan.

able(Rounds, R, Share) :-
    population(Rounds, R, Population),
    findall(N-Best, ( member(N-Program, Population), best(Program, Best) ),
            Weighted),
    findall(N, member(N-_, Weighted), All),
    findall(N, ( member(N-Best, Weighted), Best > 0 ), Able),
    sum_list(All, Total),
    Total > 0,
    sum_list(Able, Sum),
    Share is 100*Sum/Total.

best(Program, Best) :-
    plan(programs, [Antigens-_|_]),
    findall(Xi, ( member(Antigen, Antigens),
                  maze:feedback(Antigen, Program, Xi) ), Xis),
    max_list(Xis, Best).

%!  draw_programs(+Directory, +Subtitle, +Runs) is det.
%
%   Write Directory/sieve-programs.svg and .png.  Runs are Seed-Rounds.

draw_programs(Directory, Subtitle, Runs) :-
    Runs = [_-Rounds|_],
    length(Rounds, Last),
    numlist(1, Last, Ticks),
    points(Runs, Last, score(served), Served),
    points(Runs, Last, score(generated), Generated),
    points(Runs, Last, able, Able),
    draw_chart(Directory, 'sieve-programs',
               [ title('Programs in the sieve'),
                 subtitle(Subtitle), x('round of attacks'), ticks(Ticks),
                 panels([ panel('Feedback of the programs that met an attack',
                                'xi',
                                [ series('brought by agents', 0, Served,
                                         none),
                                  series('drawn at random', 1, Generated,
                                         none) ]),
                          panel('Agents with a program that gets round \c
some obstacle', '%', [ series('agents', 2, Able, none) ]) ])
               ]).

:- meta_predicate points(+, +, 3, -).

points(Runs, Last, What, Points) :-
    findall(R-Values,
            ( between(1, Last, R),
              findall(V, ( member(_-Rounds, Runs), call(What, Rounds, R, V) ),
                      Values),
              Values = [_|_] ),
            Points).

%!  programs_claims(+Runs, -Claims) is det.
%
%   What a sieve of programs should do, as the thesis has it for bit
%   patterns.

programs_claims(Runs, Claims) :-
    findall(claim(Text, Held, Found),
            ( claim(Text, Runs, Before, After),
              ( Before = [_|_], After = [_|_], maplist(<, Before, After)
              -> Held = true
              ;  Held = false
              ),
              format(atom(Found), '~w to ~w, run by run', [Before, After])
            ),
            Claims).

claim('the programs that serve in the last round are better than those drawn',
      Runs, Drawn, Served) :-
    findall(D-S, ( member(_-Rounds, Runs),
                   findall(X, ( nth1(R, Rounds, _),
                                score(generated, Rounds, R, X) ), Xs),
                   mean(Xs, D0),
                   tenth(D0, D),
                   length(Rounds, Last),
                   score(served, Rounds, Last, S0),
                   tenth(S0, S) ),
            Pairs),
    pairs_keys_values(Pairs, Drawn, Served).
claim('more of the agents can get round some obstacle than at first', Runs,
      First, Then) :-
    findall(F-T, ( member(_-Rounds, Runs),
                   length(Rounds, Last),
                   able(Rounds, 1, F0), tenth(F0, F),
                   able(Rounds, Last, T0), tenth(T0, T) ),
            Pairs),
    pairs_keys_values(Pairs, First, Then).

tenth(X, Y) :-
    Y is round(10*X)/10.0.
