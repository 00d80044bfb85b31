:- payload(bits, [provides([antigen/1, affinity/3, affinity_threshold/1,
                            feedback/3, random_antibody/3])]).

/*  Antigens and antibodies of five bits (thesis section 3.5.2): lists of
    five 0 and 1.  The best antibody is the complement of the antigen.

    Equation 3.6, the maximal Hamming distance minus the Hamming distance,
    measures how far the antibody is from the complement.  So an affinity is
    the number of bits that differ; an affinity of 4 is enough.
*/

antigen([A, B, C, D, E]) :-
    bit(A), bit(B), bit(C), bit(D), bit(E).

bit(0).
bit(1).

affinity(Antigen, Antibody, Psi) :-
    differing(Antigen, Antibody, 0, Psi).

differing([], [], Psi, Psi).
differing([X|Xs], [Y|Ys], Psi0, Psi) :-
    Psi1 is Psi0 + (X xor Y),
    differing(Xs, Ys, Psi1, Psi).

affinity_threshold(4).

%   The number whose binary digits are the bits that differ, 0 to 31.

feedback(Antigen, Antibody, Xi) :-
    number_of_difference(Antigen, Antibody, 0, Xi).

number_of_difference([], [], Xi, Xi).
number_of_difference([X|Xs], [Y|Ys], Xi0, Xi) :-
    Xi1 is 2*Xi0 + (X xor Y),
    number_of_difference(Xs, Ys, Xi1, Xi).

random_antibody(Chance0, [A, B, C, D, E], Chance) :-
    typhon_prng:chance_below(32, N, Chance0, Chance),
    A is N >> 4 /\ 1,
    B is N >> 3 /\ 1,
    C is N >> 2 /\ 1,
    D is N >> 1 /\ 1,
    E is N /\ 1.

similar(Antigen, Other) :-
    affinity(Antigen, Other, Psi),
    Psi =< 1.
