:- payload(swarm, [provides([plan/3, better/2, flight/2])]).
:- include(confirm).
:- include(fitness).

/*  Particle swarm optimization for measurements unit(Source, Settings, Value),
    with noise (thesis section 4.5).

    Each agent is a particle: a list of settings is its position.  It is drawn
    to the fittest settings that it has flown to itself, and to the fittest that
    it knows, which other agents may have told it.  Numbers have a velocity, and
    stay within the levels known in their place.  Of other levels a particle
    takes those of its own best, or of the best known, or keeps its own.

    The plan is to fly some steps, then to use the fittest settings known and to
    measure them again.
*/

steps(4).
inertia(0.7).
attraction(1.4).                % to each of the two, at most
turbulence(0.1).                % probability of any known level, in a place

%   The number of plans so far; particle(Position, Velocity, Visited), or `none`
%   before the first: Visited are its own best and its latest positions.

flight(0, none).

plan(_, Units, Plan) :-
    retract(flight(Count0, Particle0)),
    Count is Count0 + 1,
    typhon_prng:chance_hash(Count-Units, Seed),
    typhon_prng:chance_seed(Seed, Chance),
    ranked(Units, Ranked),
    known_levels(Units, Levels),
    Ranked = [_-Best|_],
    guided(Particle0, Ranked, Best, Particle1, Own),
    steps(Steps),
    flown(Steps, Particle1, guides(Own, Best, Levels), Trials, Particle, Chance),
    assertz(flight(Count, Particle)),
    repeated(Best, Again),
    append(Trials, Again, Plan).

%   guided(+Particle0, +Ranked, +Best, -Particle, -Own): Own are the fittest
%   settings that the particle has visited. A new particle begins at the best.

guided(none, _, Best, particle(Best, Still, [Best]), Best) :-
    maplist(still, Best, Still).
guided(particle(Position, Velocity, Visited), Ranked, _,
       particle(Position, Velocity, [Own]), Own) :-
    (   member(_-Own, Ranked),
        memberchk(Own, Visited)
    ->  true
    ;   Own = Position
    ).

still(_, 0).

flown(0, Particle, _, [], Particle, _) :-
    !.
flown(Steps, particle(Position0, Velocity0, Visited), Guides,
      [use(Position)|Trials], Particle, Chance0) :-
    Guides = guides(Own, Best, Levels),
    moved(Position0, Velocity0, Own, Best, Levels, Position, Velocity,
          Chance0, Chance),
    Left is Steps - 1,
    flown(Left, particle(Position, Velocity, [Position|Visited]), Guides,
          Trials, Particle, Chance).

moved([], [], [], [], [], [], [], Chance, Chance).
moved([X0|Xs0], [V0|Vs0], [P|Own], [G|Best], [Known|Levels], [X|Xs], [V|Vs],
      Chance0, Chance) :-
    turbulence(Probability),
    typhon_prng:chance_true(Probability, Turbulent, Chance0, Chance1),
    place(Turbulent, X0, V0, P, G, Known, X, V, Chance1, Chance2),
    moved(Xs0, Vs0, Own, Best, Levels, Xs, Vs, Chance2, Chance).

place(true, _, _, _, _, Known, X, 0, Chance0, Chance) :-
    typhon_prng:chance_member(X, Known, Chance0, Chance).
place(false, X0, V0, P, G, Known, X, V, Chance0, Chance) :-
    number(X0),
    !,
    inertia(W),
    attraction(C),
    typhon_prng:chance_float(U1, Chance0, Chance1),
    typhon_prng:chance_float(U2, Chance1, Chance),
    V is W*V0 + C*U1*(P - X0) + C*U2*(G - X0),
    Aim is X0 + V,
    nearest(Known, Aim, X).
place(false, X0, _, P, G, _, X, 0, Chance0, Chance) :-
    typhon_prng:chance_member(X, [X0, P, G], Chance0, Chance).

nearest(Known, Aim, Nearest) :-
    findall(Distance-Level,
            ( member(Level, Known), Distance is abs(Level - Aim) ),
            Distances),
    min_member(_-Nearest, Distances).
