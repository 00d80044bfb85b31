:- payload(maze, [provides([ start/2, actions/1, act/3, sensed/2, weight/3,
                             reached/1, shareable/2 ])]).

/*  The maze world (thesis section 4.3): a robot has to find its way from
    (50,0) to the light at (0,50).  A problem for agents(learning).

    A state is at(X, Y, Heading), where X and Y run from 0 to the size of the
    maze.  A sensor vector is sv(Light, Obstacle, Heading, Cell): Obstacle is
    1 if an obstacle or the boundary is straight ahead, else 0. The light is
    100/(1 + distance), finite and brightest at the goal, and 0 when there is
    an obstacle ahead.  Cell distinguishes cells with the same light;
    setting(signature, false) makes it 0 everywhere.

    The norm of equation 4.7 is the norm of the light alone: if the heading
    were a number in the vector, turns would have a weight.

    Units are unit(Vector0, Actions, Vector).  A turn in the open has weight
    0, so nothing could be linked through it; it is stored together with the
    next move.

    Facts of the agent with this payload replace the defaults: setting(size, N),
    setting(obstacles, List) of (X1,Y1)-(X2,Y2), lines along an axis;
    setting(light, L), the light at the goal.
*/

start(_, at(Size, 0, up)) :-
    size(Size).

size(Size) :-
    setting(size, Size),
    !.
size(50).

goal(0, Size) :-
    size(Size).

reached(at(X, Y, _)) :-
    goal(X, Y).

                /*******************************
                *            ACTIONS           *
                *******************************/

actions([forward, backward, turn_left, turn_right, turn_back]).

act(forward, State0, State) :-
    ahead(State0, Ahead),
    stepped(State0, Ahead, State).
act(backward, State0, State) :-
    behind(State0, Behind),
    stepped(State0, Behind, State).
act(turn_left, at(X, Y, Heading0), at(X, Y, Heading)) :-
    turned_left(Heading0, Heading).
act(turn_right, at(X, Y, Heading0), at(X, Y, Heading)) :-
    turned_left(Heading, Heading0).
act(turn_back, at(X, Y, Heading0), at(X, Y, Heading)) :-
    turned_left(Heading0, Side),
    turned_left(Side, Heading).

%   A move into an obstacle or over the boundary does not change the state.

stepped(State0, cell(X, Y), State) :-
    State0 = at(_, _, Heading),
    (   blocked(X, Y)
    ->  State = State0
    ;   State = at(X, Y, Heading)
    ).

ahead(at(X0, Y0, Heading), cell(X, Y)) :-
    toward(Heading, DX, DY),
    X is X0 + DX,
    Y is Y0 + DY.

behind(at(X0, Y0, Heading), cell(X, Y)) :-
    toward(Heading, DX, DY),
    X is X0 - DX,
    Y is Y0 - DY.

toward(up, 0, 1).
toward(down, 0, -1).
toward(left, -1, 0).
toward(right, 1, 0).

turned_left(up, left).
turned_left(left, down).
turned_left(down, right).
turned_left(right, up).

blocked(X, Y) :-
    (   X < 0
    ;   Y < 0
    ;   size(Size),
        ( X > Size ; Y > Size )
    ;   setting(obstacles, Obstacles),
        member((X1,Y1)-(X2,Y2), Obstacles),
        between(X1, X2, X),
        between(Y1, Y2, Y)
    ),
    !.

                /*******************************
                *            SENSORS           *
                *******************************/

sensed(State, sv(Light, Obstacle, Heading, Cell)) :-
    State = at(X, Y, Heading),
    signature(X, Y, Cell),
    ahead(State, cell(XA, YA)),
    (   blocked(XA, YA)
    ->  Obstacle = 1,
        Light = 0.0
    ;   Obstacle = 0,
        goal(GX, GY),
        brightest(Brightest),
        Light is Brightest/(1 + sqrt((X - GX)**2 + (Y - GY)**2))
    ).

brightest(Light) :-
    setting(light, Light),
    !.
brightest(100).

signature(_, _, 0) :-
    setting(signature, false),
    !.
signature(X, Y, Cell) :-
    size(Size),
    Cell is (Size + 1)*Y + X.

weight(sv(Light0, _, _, _), sv(Light, _, _, _), Weight) :-
    Weight is Light - Light0.

                /*******************************
                *         INTELLIGENCE         *
                *******************************/

shareable(Steps, Units) :-
    shareable(Steps, none, Units).

%   Turned is from(Vector) after turns only: Vector is from before these turns.

shareable([], _, []).
shareable([step(Vector0, Action, Vector, Weight)|Steps], Turned, Units) :-
    (   Weight > 0
    ->  told(Turned, Vector0, Action, Vector, Unit),
        Units = [Unit-Weight|Units1],
        shareable(Steps, none, Units1)
    ;   Weight =:= 0,
        turn(Vector0, Vector)
    ->  turning(Turned, Vector0, Turned1),
        shareable(Steps, Turned1, Units)
    ;   shareable(Steps, none, Units)
    ).

turn(sv(Light, Obstacle, Heading0, Cell),
     sv(Light, Obstacle, Heading, Cell)) :-
    Heading0 \== Heading.

turning(none, Vector, from(Vector)) :-
    !.
turning(Turned, _, Turned).

%   One turn replaces several turns.

told(from(Vector0), Vector1, Action, Vector,
     unit(Vector0, [Turn,Action], Vector)) :-
    Vector0 = sv(_, _, Heading0, _),
    Vector1 = sv(_, _, Heading1, _),
    member(Turn, [turn_left, turn_right, turn_back]),
    act(Turn, at(0, 0, Heading0), at(0, 0, Heading1)),
    !.
told(_, Vector0, Action, Vector, unit(Vector0, [Action], Vector)).
