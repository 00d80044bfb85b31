%   Hierarchies: leaders of the parts of a network, and an observer above them.
%
%   Gives: the parameter `control`, lead/5.

:- use_module('../../agents/hierarchy/operator', [hierarchy_start/4]).

fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).

label(control, "which level decides").
label(leaders, "leaders, each for itself").
label(observer, "observer").

%   lead(+Case, +Homes, +Mechanism, +Settings, -Leaders)

lead(Case, Homes, Mechanism, Settings, Leaders) :-
    level(Case.control, Level),
    hierarchy_start(Homes, payloads(hierarchy/Mechanism),
                    [ decides(Level), limit(Case.limit),
                      settings([workers-(Case.workers)|Settings]) ],
                    Leaders).

level(Level, Level) :-
    memberchk(Level, [leaders, observer]),
    !.
level(_, none).
