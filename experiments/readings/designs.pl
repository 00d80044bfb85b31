:- module(readings_designs,
          [ readings/4                  % +Design, +Seed, +Open, -Readings
          ]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(lists), [append/3, list_to_set/2, member/2]).
:- use_module(library(random), [random_member/2]).

/** <module> Which readings are tried

*Threading*: any; random/1 seeds the generator of the calling thread.
*/

%!  readings(+Design, +Seed, +Open, -Readings) is det.
%
%   Open are pairs Parameter-Values.  A reading is a list of pairs
%   Parameter-Value; [] leaves all as it is, and is the first of Readings.
%   Design is
%
%     - one: each value alone
%     - pairs: each value alone, and each two values of different parameters
%     - random(Count): Count readings with a value, or that of the study, for
%       each parameter, drawn with Seed
%
%   @error domain_error(design, Design)

readings(one, _, Open, [[]|Readings]) :-
    !,
    findall([Value], value(Open, Value), Readings).
readings(pairs, _, Open, Readings) :-
    !,
    readings(one, _, Open, Single),
    findall([A, B],
            ( append(_, [First|Later], Open),
              value([First], A),
              value(Later, B) ),
            Pairs),
    append(Single, Pairs, Readings).
readings(random(Count), Seed, Open, [[]|Readings]) :-
    !,
    set_random(seed(Seed)),
    findall(Reading, ( between(1, Count, _), drawn(Open, Reading) ), Drawn),
    list_to_set(Drawn, Readings).
readings(Design, _, _, _) :-
    domain_error(design, Design).

value(Open, Parameter-Value) :-
    member(Parameter-Values, Open),
    member(Value, Values).

drawn([], []).
drawn([Parameter-Values|Open], Reading) :-
    random_member(Value, [as_it_is|Values]),
    (   Value == as_it_is
    ->  Reading = Rest
    ;   Reading = [Parameter-Value|Rest]
    ),
    drawn(Open, Rest).
