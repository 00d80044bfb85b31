:- module(typhon_source_view,
          [ agent_listing/1,            % +Agent
            goals_shown/5,              % +Agent, +Facts, +Goals, -Shown, -Text
            goal_named/4                % +Clauses, +Lists, +Goal, -Named
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2, nth1/3, nth1/4]).
:- use_module('../kernel/base/text', [format_shown/2, print_clause/3]).
:- use_module('../kernel/program',
              [clause_parts/3, goals_body/2]).
:- use_module('../kernel/lifecycle', [agent_answer/3]).
:- use_module(administration, [agent_property/2]).
:- autoload('source_view/clause_location', [body_list/2]).
:- use_module('../kernel/base/names', [counted/3]).
:- autoload('source_view/variable_names',
            [ clause_bindings/3, goals_bindings/4, goals_places/3,
              name_goal/4 ]).

/** <module> Source view: goals of agents in the text of their programs

The layer finds the clause from which a goal comes, and the names of its
variables in that clause.  This is its interface.  Its other modules are loaded
when an agent is listed, or becomes faulty.

*Threading*: any thread.
*/

%!  agent_listing(+Agent) is det.
%
%   Print the program of Agent, with the names of variables if it was read from
%   a file, its facts, and its remaining goals, as clauses.  An arrow marks the
%   next goal; if several clauses end in the same way, each of them has an
%   arrow.  The goals of a running agent are not known, see agent_step/1.
%
%   @error existence_error(agent, Agent)

agent_listing(Agent) :-
    agent_answer(Agent, program, Program-Names),
    findall(Property, agent_property(Agent, Property), Properties),
    memberchk(facts(Facts), Properties),
    memberchk(goals(Goals), Properties),
    about(Agent, Properties),
    Program = program(_, _, _, Static),
    append(Static, Facts, Clauses),
    goals_places(Clauses, Goals, Places),
    list_program(Program, Names, Places),
    length(Static, Count),
    part(Facts, '% facts', list_clauses(Facts, [], Count, Places)),
    goals_bindings(Clauses, Names, Goals, Bindings),
    part(Goals, '% goals left', list_goals(Goals, Bindings)).

about(Agent, Properties) :-
    memberchk(host(Host), Properties),
    memberchk(state(State), Properties),
    memberchk(hops(Hops), Properties),
    functor(State, Word, _),
    counted(Hops, hop, Count),
    format_shown('% ~w~n% on ~w, ~w, ~w~n~n', [Agent, Host, Word, Count]).

%!  goals_shown(+Agent, +Facts, +Goals, -Shown, -Text:string) is det.
%
%   Shown are Goals, the remaining goals of Agent, which has these Facts, with
%   '$VAR'(Name) for variables whose names in the program are known.  Text is
%   the part of agent_listing/1 with the declarations and the clauses.
%
%   @error existence_error(agent, Agent)

goals_shown(Agent, Facts, Goals, Shown, Text) :-
    agent_answer(Agent, program, Program-Names),
    Program = program(_, _, _, Static),
    append(Static, Facts, Clauses),
    goals_places(Clauses, Goals, Places),
    with_output_to(string(Text), list_program(Program, Names, Places)),
    goals_bindings(Clauses, Names, Goals, Bindings),
    copy_term_nat(Goals-Bindings, Shown-Named),
    maplist(bound_to_name, Named).

bound_to_name(Name='$VAR'(Name)).

%!  goal_named(+Clauses, +Lists, +Goal, -Named) is det.
%
%   Named is Goal with '$VAR'(Name) for variables, if all clauses that could
%   have called Goal agree on their names.  Lists has the names of variables of
%   the first clauses of Clauses, one list for each clause.

goal_named(Clauses, Lists, Goal, Named) :-
    name_goal(Clauses, Lists, Goal, Named).

list_program(program(Name, State, Libraries, Clauses), Names, Places) :-
    ( State == [] -> Options = [] ; Options = [state(State)] ),
    portray((:- agent(Name, Options)), []),
    forall(member(Library-Imports, Libraries),
           library(Imports, Library)),
    list_clauses(Clauses, Names, 0, Places).

library(all, Library) :-
    !,
    portray((:- use_module(Library)), []).
library(Imports, Library) :-
    portray((:- use_module(Library, Imports)), []).

:- meta_predicate part(+, +, 0).

part([], _, _) :-
    !.
part(_, Title, Goal) :-
    format('~n~w~n', [Title]),
    call(Goal).

list_goals(Goals, Bindings) :-
    goals_body(Goals, Body),
    portray((:- Body), Bindings).

portray(Clause, Bindings) :-
    current_output(Out),
    print_clause(Out, Clause, [variable_names(Bindings)]).

                /*******************************
                *            CLAUSES           *
                *******************************/

%   list_clauses(+Clauses, +Names, +Before, +Places): print an empty line
%   between clauses of different predicates.

list_clauses(Clauses, Names, Before, Places) :-
    forall(nth1(I, Clauses, Clause),
           ( N is Before+I,
             space(I, Clauses, Clause),
             ( nth1(I, Names, Own) -> true ; Own = [] ),
             clause_bindings(Clause, Own, Bindings),
             list_clause(Clause, Bindings, N, Places) )).

space(I, Clauses, Clause) :-
    I0 is I-1,
    (   nth1(I0, Clauses, Previous),
        clause_name(Previous, Name),
        clause_name(Clause, Name),
        Clause \= (_:-_)
    ->  true
    ;   nl
    ).

clause_name(Clause, Name/Arity) :-
    clause_parts(Clause, Head, _),
    functor(Head, Name, Arity).

list_clause(Clause, Bindings, N, Places) :-
    findall(I, member(N-I, Places), [At]),
    !,
    marked(Clause, At, Marked),
    with_output_to(string(Text), portray(Marked, Bindings)),
    split_string(Text, "\n", "", Lines),
    with_arrow(Lines).
list_clause(Clause, Bindings, _, _) :-
    portray(Clause, Bindings).

%   The mark is a goal of its own, so it is printed on a line of its own.

marked(Clause, At, (Head:-Body)) :-
    clause_parts(Clause, Head, Body0),
    body_list(Body0, Goals0),
    nth1(At, Goals, '$typhon_here', Goals0),
    goals_body(Goals, Body).

with_arrow([Line|Lines]) :-
    sub_string(Line, _, _, _, "'$typhon_here'"),
    !,
    (   Lines = [Next|More],
        string_concat("    ", Goal, Next)
    ->  format('=>  ~s~n', [Goal]),
        with_arrow(More)
    ;   with_arrow(Lines)
    ).
with_arrow([""]) :-
    !.
with_arrow([Line|Lines]) :-
    format('~s~n', [Line]),
    with_arrow(Lines).
with_arrow([]).
