:- module(typhon_page_queries,
          [ query_answer/2,             % +Message, -Answer
            present_scene/1,            % -Dict
            world_start/1,              % +Options
            world_stop/0,
            world_shown/0
          ]).
:- use_module(library(apply), [maplist/3, partition/4]).
:- use_module(library(error), [domain_error/2, existence_error/2, must_be/2]).
:- use_module(library(lists),
              [last/2, member/2, memberchk/2, nth1/3, selectchk/4]).
:- use_module(library(option), [option/2]).
:- use_module(library(solution_sequences), [limit/2]).
:- use_module('../../kernel/agent', [agent/5]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/host', [address_parts/3]).
:- use_module('../../kernel/lifecycle', [agent_join/3]).
:- use_module('../../network', [network_property/2]).
:- use_module('../../tools', [host_report/2]).
:- use_module('../administration', [agent_property/2]).
:- use_module('../source_view', [goals_shown/5]).
:- use_module(overlays, [mechanism_dicts/1, mechanism_parameters/3, program_names/1]).
:- use_module(protocol,
              [ agent_summary_dict/2, name_text/2, page_time/2, place_text/2,
                scene_dict/3, text/2 ]).
:- autoload(replay, [replay_of_text/3]).
:- use_module(editor, [name_in/3, on_console/1, text_in/3]).
:- use_module(models, [model_dict/2]).
:- use_module(runs, [run_dict/1]).
:- use_module(sources, [sources_look/1, sources_show/1, sources_tree/1]).

/** <module> Queries of browsers, and the answers

  | ask        | with    | answer                                        |
  | ---------- | ------- | --------------------------------------------- |
  | survey     |         | all hosts and agents, as in the first message |
  | agent      | `agent` | all properties of it, or its outcome          |
  | host       | `host`  | all properties of it                          |
  | networks   |         | the networks that this process has started    |
  | mechanisms |         | the operators of `agents/`, and their arguments |
  | parameters | `mechanism`, `predicate` | the settings that it takes, with ranges |
  | programs   |         | names of agent programs that are found        |
  | tree       |         | supervisors and the agents below them         |
  | world      |         | the picture of the world, SVG                 |
  | run        |         | the state of virtual time, see module `runs`  |
  | model      | `run`, `since` | what module `models` says               |
  | replay     | `title`, `text` | the log of that text, see module `replay` |

A query changes nothing, and leads only to hosts that the page shows.

With the option world(Goal) the page has a view of the surroundings of the
agents, such as a floor plan, or fields.  call(Goal, Svg) gives its present
picture, the text of an SVG document, which a browser requests twice a second
while it shows the view.  The browser shows it as an image: no script in it
runs, and nothing that it refers to is loaded.

*Threading*: any thread that may wait; several may call Goal.  One thread at a
time starts and stops the world.
*/

%!  query_answer(+Message:dict, -Answer) is det.
%
%   Answer is the answer to the query in Message, see above.
%
%   @error domain_error(question, Message) Message has an unknown query
%   @error existence_error(page_field, Key), and the errors of the query

query_answer(Message, Answer) :-
    get_dict(ask, Message, Text),
    atom_string(What, Text),
    on_console(answer(What, Message, Answer)),
    !.
query_answer(Message, _) :-
    domain_error(question, Message).

%   Users would not read longer lists of facts or messages.

most(300).

answer(survey, _, Dict) :-
    present_scene(Dict).
answer(agent, Message, Dict) :-
    name_in(agent, Message, Agent),
    must_be_shown(agent, Agent),
    agent_dict(Agent, Dict).
answer(host, Message, Dict) :-
    name_in(host, Message, Host),
    must_be_shown(host, Host),
    host_dict(Host, Dict).
answer(networks, _, Dicts) :-
    findall(Dict, network_dict(Dict), Dicts).
answer(mechanisms, _, Dicts) :-
    mechanism_dicts(Dicts).
answer(parameters, Message, Dicts) :-
    name_in(mechanism, Message, Mechanism),
    name_in(predicate, Message, Predicate),
    mechanism_parameters(Mechanism, Predicate, Dicts).
answer(programs, _, Names) :-
    program_names(Names).
answer(tree, _, Dicts) :-
    sources_tree(Trees),
    maplist(node_dict, Trees, Dicts).
answer(world, _, Svg) :-
    world_picture(Svg).
answer(run, _, Dict) :-
    run_dict(Dict).
answer(model, Message, Dict) :-
    model_dict(Message, Dict).
answer(replay, Message, Dict) :-
    text_in(title, Message, Title),
    text_in(text, Message, Text),
    replay_of_text(Title, Text, Dict).

%   must_be_shown(+Kind, +Name): the address in Name, to which a query would
%   connect, is that of a host on the page; else any viewer could let this
%   process connect to any address.
%
%   @error existence_error(Kind, Name)

must_be_shown(Kind, Name) :-
    (   sub_atom(Name, _, _, _, @),
        \+ agent(Name, _, _, _, _),
        \+ ( last_part(Name, Endpoint), sources_show(Endpoint) )
    ->  existence_error(Kind, Name)
    ;   true
    ).

last_part(Name, Endpoint) :-
    atomic_list_concat(Parts, @, Name),
    last(Parts, Endpoint).

%!  present_scene(-Dict) is det.
%
%   Dict is a snapshot of all hosts and agents of the page, see protocol.

present_scene(Dict) :-
    sources_look(Scene),
    monotonic_time(Now),
    page_time(Now, Time),
    scene_dict(Time, Scene, Dict).

                /*******************************
                *           AN AGENT           *
                *******************************/

agent_dict(Agent, Dict) :-
    findall(P, agent_property(Agent, P), Properties),
    name_text(Agent, Id),
    (   Properties == []
    ->  agent_join(Agent, Outcome, 0),
        text(Outcome, Text),
        Dict = _{id:Id, outcome:Text}
    ;   memberchk(facts(Facts), Properties),
        selectchk(goals(Goals), Properties, goals(Shown), Named),
        goals_shown(Agent, Facts, Goals, Shown, Text),
        findall(Key-Value, agent_shown(Named, Key, Value), Pairs),
        program_dict(Text, Program),
        dict_pairs(Dict, _, [id-Id, program-Program|Pairs])
    ).

agent_shown(Properties, Key, Value) :-
    member(Property, Properties),
    property_shown(Property, Key, Value).

property_shown(host(Host), host, Text) :- name_text(Host, Text).
property_shown(program(Name), name, Text) :- name_text(Name, Text).
property_shown(home(Home), home, Text) :- name_text(Home, Text).
property_shown(state(State), state, Text) :- text(State, Text).
property_shown(busy(Seconds), busy, Seconds).
property_shown(hops(Hops), hops, Hops).
property_shown(payloads(Names), payloads, Texts) :-
    maplist(name_text, Names, Texts).
property_shown(goals(Goals), goals, Texts) :- first_texts(Goals, Texts).
property_shown(facts(Facts), facts, Texts) :- first_texts(Facts, Texts).
property_shown(facts(Facts), fact_count, Count) :- length(Facts, Count).
property_shown(mailbox(Mail), mailbox, Rows) :- first_of(Mail, mail_row, Rows).
property_shown(fault(fault(Error, Goal, Place, Host)), fault,
               _{ error:ErrorText, goal:GoalText, place:PlaceText,
                  host:HostText }) :-
    maplist(text, [Error, Goal], [ErrorText, GoalText]),
    place_text(Place, PlaceText),
    name_text(Host, HostText).

first_texts(Terms, Texts) :-
    first_of(Terms, text, Texts).

:- meta_predicate first_of(+, 2, -).

first_of(List, Goal, Texts) :-
    most(Most),
    findall(Text,
            limit(Most, ( member(Item, List), call(Goal, Item, Text) )),
            Texts).

mail_row(Message, [FromText, Text]) :-
    (   Message = From-Term
    ->  name_text(From, FromText),
        text(Term, Text)
    ;   FromText = "",
        text(Message, Text)
    ).

%   An arrow marks the line of the next goal.

program_dict(Text, _{lines:Lines, here:Here}) :-
    split_string(Text, "", "\n", [Program]),
    split_string(Program, "\n", "", Marked),
    findall(N, ( nth1(N, Marked, Line), string_concat("=>", _, Line) ), Here),
    maplist(without_arrow, Marked, Lines).

without_arrow(Line, Plain) :-
    (   string_concat("=>", Rest, Line)
    ->  string_concat("  ", Rest, Plain)
    ;   Plain = Line
    ).

                /*******************************
                *            A HOST            *
                *******************************/

host_dict(Host, Dict) :-
    host_report(Host, close_up(Properties, Options, Tuples, Clauses,
                                 Services)),
    memberchk(address(Address), Properties),
    name_text(Address, Id),
    address_parts(Address, _, Endpoint),
    name_text(Endpoint, Process),
    memberchk(load(Load), Properties),
    memberchk(capacity(Capacity), Properties),
    text(Capacity, CapacityText),
    memberchk(neighbours(Neighbours), Properties),
    maplist(name_text, Neighbours, Links),
    findall(Row, ( member(hop_time(Way, Stats), Properties),
                   hop_row(Way, Stats, Row) ), HopTimes),
    partition(pheromone, Tuples, Pheromones, Facts),
    Dict = _{id:Id, process:Process, load:Load, capacity:CapacityText,
             links:Links, options:Options, tuples:Facts,
             pheromones:Pheromones, place:Clauses, services:Services,
             hop_times:HopTimes}.

pheromone(Text) :-
    string_concat("pheromone(", _, Text).

hop_row(Way, stats(Count, Min, Mean, Max), [Text, Count|Times]) :-
    Count > 0,
    name_text(Way, Text),
    Times = [Min, Mean, Max].

node_dict(node(Agent, Relation, Summary, Below), Dict) :-
    maplist(name_text, [Agent, Relation], [Id, RelationText]),
    maplist(node_dict, Below, Dicts),
    summary_dict(Summary, Agent, Dict0),
    Dict = Dict0.put(_{id:Id, relation:RelationText, below:Dicts}).

summary_dict(none, _, Dict) =>
    Dict = _{host:"", program:"", status:"", doing:""}.
summary_dict(Summary, Agent, Dict) =>
    agent_summary_dict(agent(Agent, Summary), Dict).

network_dict(_{name:Name, hosts:HostTexts, seed:Seed, processes:Pids}) :-
    network_property(Network, hosts(Hosts)),
    name_text(Network, Name),
    maplist(name_text, Hosts, HostTexts),
    network_property(Network, seed(Seed)),
    network_property(Network, processes(Pids)).

                /*******************************
                *          THE WORLD           *
                *******************************/

:- dynamic world_goal/1.        % Goal of the page that is served

%!  world_start(+Options) is det.
%!  world_stop is det.
%!  world_shown is semidet.
%
%   Set the goal of the view World from the option world(Goal); remove it;
%   succeed if the page has that view.

world_start(Options) :-
    (   option(world(Goal), Options)
    ->  assertz(world_goal(Goal))
    ;   true
    ).

world_stop :-
    retractall(world_goal(_)).

world_shown :-
    world_goal(_).

%   @error existence_error(page_view, world), and the errors of Goal

world_picture(Svg) :-
    (   world_goal(Goal)
    ->  once(call(Goal, Text)),
        must_be(text, Text),
        format(string(Svg), '~w', [Text])
    ;   existence_error(page_view, world)
    ).
