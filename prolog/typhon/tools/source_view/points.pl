:- module(typhon_points,
          [ point/3,                    % +Body, -Sequel, -End
            goals_normal/2,             % +Goals0, -Goals
            goal_level/3                % +Goal, +Goals, -Left
          ]).
:- use_module(library(lists), [append/3]).
:- use_module('../../kernel/program', [body_goals/4, goals_body/2, plain_goals/2]).

/** <module> Points that the machine can come to in a clause

The machine takes a clause body apart as it runs it, see typhon_machine.
Here are all the lists of goals that it can have left of one.

*Threading*: pure.
*/

%!  goals_normal(+Goals0, -Goals) is det.
%
%   Goals0 as a clause body would be.

goals_normal(Goals0, Goals) :-
    goals_body(Goals0, Body),
    body_list(Body, Goals).

body_list(Body, Goals) :-
    body_goals(Body, _, Goals0, []),
    plain_goals(Goals0, Goals).

%!  point(+Body, -Sequel, -End) is nondet.
%
%   Sequel is what the machine still has to do of Body when it has come to the
%   first goal of Sequel.  End is `open` if what comes after the body follows,
%   `closed` inside a condition.

point(Body, Sequel, End) :-
    body_list(Body, Goals),
    point_in(Goals, [], open, Sequel, End).

%   point_in(+Goals, +After, +End0, -Sequel, -End): After comes after Goals.

point_in(Goals, After0, End0, Sequel, End) :-
    append(_, [Goal|Goals1], Goals),
    append(Goals1, After0, After),
    (   Sequel = [Goal|After],
        End = End0
    ;   nonvar(Goal),
        part(Goal, Part, How),
        body_list(Part, Goals2),
        part_point(How, Goals2, After, End0, Sequel, End)
    ).

part_point(continued, Goals, After, End0, Sequel, End) :-
    point_in(Goals, After, End0, Sequel, End).
part_point(apart, Goals, _, _, Sequel, End) :-
    point_in(Goals, [], closed, Sequel, End).

%   part(+Goal, -Part, -How) is nondet: the machine goes on in Part, with what
%   comes after Goal, or runs it apart.

part((If->_), If, apart).
part((_->Then), Then, continued).
part((If*->_), If, apart).
part((_*->Then), Then, continued).
part((Or;_), Part, How) :-
    part_of_or(Or, Part, How).
part((_;Else), Else, continued).
part(call(Goal), Goal, continued).
part(once(Goal), Goal, apart).
part(ignore(Goal), Goal, apart).
part(catch(Goal,_,_), Goal, apart).
part(catch(_,_,Recovery), Recovery, continued).
part(\+ Goal, Goal, apart).

part_of_or(Or, Part, How) :-
    (   nonvar(Or),
        ( Or = (_->_) ; Or = (_*->_) )
    ->  part(Or, Part, How)
    ;   Part = Or,
        How = continued
    ).

%!  goal_level(+Goal, +Goals, -Left) is det.
%
%   Left begins with Goal, in Goals or in what is apart in the first of them;
%   it is Goals if Goal is not to be found.

goal_level(Goal, [First|Goals], Left) :-
    (   First == Goal
    ->  Left = [First|Goals]
    ;   nonvar(First),
        apart(First, Part),
        body_list(Part, Left0),
        goal_level(Goal, Left0, Left)
    ->  true
    ;   Left = [First|Goals]
    ).

apart(Goal, Part) :-
    part(Goal, Part, apart),
    !.
