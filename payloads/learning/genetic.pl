:- payload(genetic, [provides([plan/3, better/2, plans/1])]).
:- include(confirm).
:- include(fitness).

/*  A genetic algorithm for measurements unit(Source, Genes, Value): lists of
    genes of one length, and their measured fitness, with noise.

    The population of an agent consists of the fittest individuals that it
    knows, from its own executions and from agents that it met.  So agents are
    islands, and sharing is migration; as the bag is emptied with each plan,
    immigrants are parents in one generation, and their genes survive in their
    children.

    The plan is to try children of the population, then to use its fittest
    member and to measure it again.  Parents are chosen by tournaments; a
    child has each gene from one of them; with a small probability a gene
    mutates to another one known in its place.
*/

members(16).                    % individuals in the population
children(4).                    % in a generation
tournament(3).
mutation(0.15).                 % of a gene

%   The number of generations so far; it seeds the next one.

plans(0).

plan(_, Units, Plan) :-
    retract(plans(Count0)),
    Count is Count0 + 1,
    assertz(plans(Count)),
    planned(Units, Count, Plan).

planned(Units, Count, Plan) :-
    typhon_prng:chance_hash(Count-Units, Seed),
    typhon_prng:chance_seed(Seed, Chance),
    population(Units, Population),
    known_levels(Units, Pool),
    children(Number),
    offspring(Number, Population, Pool, Trials, Chance),
    Population = [_-Fittest|_],
    repeated(Fittest, Again),
    append(Trials, Again, Plan).

                /*******************************
                *          POPULATION          *
                *******************************/

%   population(+Units, -Population): Fitness-Genes, the fittest first.

population(Units, Population) :-
    ranked(Units, Ranked),
    members(Most),
    findall(Member, limit(Most, member(Member, Ranked)), Population).

                /*******************************
                *           OFFSPRING          *
                *******************************/

offspring(0, _, _, [], _) :-
    !.
offspring(Number, Population, Pool, [use(Child)|Trials], Chance0) :-
    parent(Population, Mother, Chance0, Chance1),
    parent(Population, Father, Chance1, Chance2),
    child(Mother, Father, Pool, Child, Chance2, Chance),
    Left is Number - 1,
    offspring(Left, Population, Pool, Trials, Chance).

%   Genes is the fittest of a few random individuals: the least index, because
%   Population is in order of fitness.

parent(Population, Genes, Chance0, Chance) :-
    length(Population, Size),
    tournament(Rounds),
    lowest(Rounds, Size, Size, Index, Chance0, Chance),
    nth0(Index, Population, _-Genes).

lowest(0, _, Index, Index, Chance, Chance) :-
    !.
lowest(Rounds, Size, Index0, Index, Chance0, Chance) :-
    typhon_prng:chance_below(Size, Drawn, Chance0, Chance1),
    Index1 is min(Index0, Drawn),
    Left is Rounds - 1,
    lowest(Left, Size, Index1, Index, Chance1, Chance).

child([], [], [], [], Chance, Chance).
child([M|Mother], [F|Father], [Genes|Pool], [Gene|Child], Chance0, Chance) :-
    typhon_prng:chance_member(Gene0, [M,F], Chance0, Chance1),
    mutation(Probability),
    typhon_prng:chance_true(Probability, Mutates, Chance1, Chance2),
    mutated(Mutates, Gene0, Genes, Gene, Chance2, Chance3),
    child(Mother, Father, Pool, Child, Chance3, Chance).

mutated(false, Gene, _, Gene, Chance, Chance).
mutated(true, _, Genes, Gene, Chance0, Chance) :-
    typhon_prng:chance_member(Gene, Genes, Chance0, Chance).
