:- payload(solutions, [provides([affinity/3, affinity_threshold/1, feedback/3,
                                 random_antibody/3])]).
:- include('../learning/printer').

/*  Solutions that agents have learned, as antibodies of the sieve (thesis section
    4.5): settings of printers.

    The antigen `print` is a printer that needs settings.  An antibody is
    found(Algorithm, Settings).  The fact setting(candidates, List) has those that
    hosts draw; setting(printers, Seed) determines the printers.
*/

affinity_threshold(1).

affinity(print, found(_, _), 1).

%   feedback(+Antigen, +Antibody, -Xi): 31 for a perfect page, 0 from a quality
%   of 0.75 down.

feedback(print, found(_, Settings), Xi) :-
    printer(Printer),
    quality(Printer, Settings, Quality),
    Xi is 31*max(0, (Quality - 0.75)/0.25).

random_antibody(Chance0, Antibody, Chance) :-
    setting(candidates, Candidates),
    typhon_prng:chance_member(Antibody, Candidates, Chance0, Chance).
