:- module(course_people, []).

% Lesson 8: agents that ask people.

:- use_module(course).
:- use_module('../../../prolog/typhon/options/people',
              [person_answer/3, person_page/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, nth1/3, select/3]).

:- multifile course:criterion/3.

:- meta_predicate with_people(+, 2).

%   with_people(+Count, :Goal): call(Goal, Home, People) in a star.

with_people(Count, Goal) :-
    Size is Count+1,
    in_network(star(Size),
               [hosts([ people(true), policy(guarded),
                        quota([seconds(100_000)]) ])],
               course_people:on_star(Goal)).

on_star(Goal, [Home|People]) :-
    call(Goal, Home, People).

%   asked(+Person, -Number, -What, -Kind): a question waits for an answer.

asked(Person, Number, What, Kind) :-
    page(Person, Number, What, Kind),
    Kind \== shown.

page(Person, Number, What, Kind) :-
    host_name(Person, Name),
    person_page(Name, Rows),
    member(asked(Number, _, What, Kind), Rows).

answer(Person, Number, Given) :-
    host_name(Person, Name),
    person_answer(Name, Number, Given).

host_name(Person, Name) :-
    atomic_list_concat([Name|_], @, Person).

shown(Person, What) :-
    page(Person, _, What, shown).

                /*******************************
                *            SPEAKER           *
                *******************************/

course:criterion(speaker, 'more than half of the votes decide',
                 course_people:elects([[a,b,b]], b, [[a,b,c]])).
course:criterion(speaker, 'the two with the most votes are chosen from again',
                 course_people:elects([[c,a,b,c,b], [b,b,b,c,c]], b,
                                      [[a,b,c], [b,c]])).
course:criterion(speaker, 'half of the votes do not decide',
                 course_people:elects([[b,a,c,b], [a,a,a,b]], a,
                                      [[a,b,c], [a,b]])).

%   elects(+Ballots, +Speaker, +Choices, +File): Ballots are lists with the
%   vote of each person, Choices what people choose from.

elects(Ballots, Speaker, Choices, File) :-
    Ballots = [Votes|_],
    length(Votes, Count),
    with_people(Count, course_people:election(File, Ballots, Speaker, Choices)).

election(File, Ballots, Speaker, Choices, Home, People) :-
    on_host(File, Home, [candidates([a,b,c])], Agent),
    maplist(ballot(Home, People), Ballots, Found),
    ended(Agent, Result),
    expect('what people choose from', Found, Choices),
    expect('the result', Result, Speaker),
    findall(What, ( member(Person, People), shown(Person, What) ), Shown),
    findall(speaker(Speaker), member(_, People), Expected),
    expect('what people see', Shown, Expected).

%   The order in which people are asked does not matter.

ballot(Home, People, Votes, Choices) :-
    findall(Person-Vote, ( nth1(I, People, Person), nth1(I, Votes, Vote) ),
            Pairs),
    voted(Pairs, Home, none, Choices).

voted([], _, Choices, Choices).
voted(Pairs, Home, _, Choices) :-
    Pairs = [_|_],
    time_passes(Home, 5),
    (   select(Person-Vote, Pairs, Rest),
        asked(Person, Number, _, choice(Names))
    ->  true
    ;   expect('people that are asked', none, one_more)
    ),
    msort(Names, Sorted),
    (   nth1(Place, Names, Vote)
    ->  answer(Person, Number, Place)
    ;   expect('what people choose from', Names, with(Vote))
    ),
    voted(Rest, Home, Sorted, Choices).

                /*******************************
                *             LINE             *
                *******************************/

course:criterion(line, 'all people are asked at the same time',
                 course_people:asks_all).
course:criterion(line, 'people see their places by their heights',
                 course_people:places(["170", "98.5", "165"], [3, 1, 2])).
course:criterion(line, 'the result are the hosts in this order',
                 course_people:places(["150", "160"], [1, 2])).

asks_all(File) :-
    with_people(4, course_people:all_asked(File)).

all_asked(File, Home, People) :-
    on_host(File, Home, _),
    time_passes(Home, 20),
    findall(Person, ( member(Person, People), asked(Person, _, _, _) ), Asked),
    expect('people that are asked', Asked, People).

places(Heights, Places, File) :-
    length(Heights, Count),
    with_people(Count, course_people:in_line(File, Heights, Places)).

in_line(File, Heights, Places, Home, People) :-
    on_host(File, Home, Agent),
    time_passes(Home, 20),
    forall(( nth1(I, People, Person), asked(Person, Number, number(_), text) ),
           ( nth1(I, Heights, Height),
             answer(Person, Number, Height) )),
    ended(Agent, Result),
    findall(Place, ( member(Person, People), shown(Person, place(Place)) ),
            Found),
    expect('the places that people see', Found, Places),
    findall(Place-Person, ( nth1(I, Places, Place), nth1(I, People, Person) ),
            Pairs),
    keysort(Pairs, Sorted),
    findall(Person, member(_-Person, Sorted), Line),
    expect('the result', Result, Line).
