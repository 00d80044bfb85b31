:- payload(greedy, [provides([plan/3, better/2])]).

/*  The learning algorithm of thesis section 4.3.5: the transitions an agent
    knows are links of a tree, whose root is the start, or the known vector
    most similar to it.  The plan is the longest branch; among equal ones, the
    one of greatest weight, which ends nearest to the goal; among these, the
    one with the fewest actions.

    Weights are positive, so the links have no cycle, and the best branch from
    each vector is found by processing the links in order of decreasing light.
    A depth-first search would find the same, in exponential time.
*/

plan(Start, Units, Plan) :-
    findall(Light-unit(Vector0, Actions, Vector),
            ( member(unit(Vector0, Actions, Vector)-_, Units),
              arg(1, Vector0, Light) ),
            Keyed),
    sort(1, @>=, Keyed, Falling),
    empty_assoc(Best0),
    best(Falling, Best0, Best),
    root(Start, Best, Root),
    branch(Root, Best, Plan).

%   best(+Links, +Best0, -Best): Best maps each vector to
%   best(Length, Light, Saving, Actions, Next): the length of the best branch
%   from it, the light at its end, and minus the number of its actions.

best([], Best, Best).
best([_-unit(Vector0, Actions, Vector)|Links], Best0, Best) :-
    from(Vector, Best0, Length0, Light, Saving0),
    length(Actions, Count),
    Length is Length0 + 1,
    Saving is Saving0 - Count,
    Branch = best(Length, Light, Saving, Actions, Vector),
    (   get_assoc(Vector0, Best0, Other),
        Other @>= Branch
    ->  Best1 = Best0
    ;   put_assoc(Vector0, Best0, Branch, Best1)
    ),
    best(Links, Best1, Best).

from(Vector, Best, Length, Light, Saving) :-
    get_assoc(Vector, Best, best(Length, Light, Saving, _, _)),
    !.
from(Vector, _, 0, Light, 0) :-
    arg(1, Vector, Light).

branch(Vector, Best, Plan) :-
    get_assoc(Vector, Best, best(_, _, _, Actions, Next)),
    !,
    append(Actions, Rest, Plan),
    branch(Next, Best, Rest).
branch(_, _, []).

%   root(+Start, +Best, -Root): Root is the vector most similar to Start by
%   cosine distance.

root(Start, Best, Start) :-
    get_assoc(Start, Best, _),
    !.
root(Start, Best, Root) :-
    assoc_to_keys(Best, Vectors),
    findall(Cosine-Vector,
            ( member(Vector, Vectors), cosine(Start, Vector, Cosine) ),
            Weighed),
    max_member(_-Root, Weighed).

cosine(Vector1, Vector2, Cosine) :-
    numbers(Vector1, A1, B1, C1),
    numbers(Vector2, A2, B2, C2),
    Dot is A1*A2 + B1*B2 + C1*C2,
    Norms is sqrt((A1**2 + B1**2 + C1**2) * (A2**2 + B2**2 + C2**2)),
    (   Norms =:= 0
    ->  Cosine = 0
    ;   Cosine is Dot/Norms
    ).

numbers(sv(Light, Obstacle, Heading, _), Light, Obstacle, Direction) :-
    nth0(Direction, [up, left, down, right], Heading),
    !.

%   True if Actions has fewer actions than Others.

better(Actions, Others) :-
    length(Actions, Length),
    length(Others, OthersLength),
    Length < OthersLength.
