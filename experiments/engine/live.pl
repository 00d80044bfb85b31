:- module(study_live,
          [ live/2                      % +Study, +Request
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [list_to_set/2, max_list/2, member/2, min_list/2, selectchk/3]).
:- use_module('../../prolog/typhon', [network_property/2, network_stop/1]).
:- use_module('../../prolog/typhon/kernel/base/private', [private_folder/2]).
:- use_module('../../prolog/typhon/network/log_file', [log_size/2]).
:- use_module(cases, [parameters/3, study_cases/3]).
:- use_module(follow, [new_lines/4]).
:- use_module(run, [case_begins/5, study_network/4, study_run/3, study_view/3]).
:- use_module(studies, [study_call/2, study_title/3]).

/** <module> A study as the model of a page

People choose values of the parameters, watch one run, and its measures so far.

*Threading*: as of page/models.pl; one study in a process.
*/

:- dynamic
    live/4,                     % Directory, File, Case, Network
    event_seen/1,               % Event
    seen_to/1.                  % Position in the log

%!  live(+Study, +Request) is semidet.
%
%   For the option model(live(Study)) of page_start/1.  Parameters whose values
%   are numbers have ranges; the seed is one of them.
%
%   @error study_parameter(Study, Name), study_goal_failed(Name/Arity)

live(Study, about(Title, [parameter(seed, 1, range(1, 100, 1))|Parameters])) :-
    study_title(Study, _, Title),
    parameters(Study, [], All),
    findall(parameter(Name, Value, Range),
            ( member(parameter(Name, Given, Why), All),
              choice(Why, Given, Value, Range) ),
            Parameters).
live(Study, set_up(Pairs)) :-
    selectchk(seed-Seed, Pairs, Others),
    maplist(given, Others, Given),
    study_cases(Study, Given, Cases),
    (   Cases = [Case0|_]
    ->  true
    ;   throw(error(study_skips(Given), _))
    ),
    set_up(Study, Case0, Seed).
live(Study, run) :-
    live(_, _, Case, Network),
    study_run(Study, Case, Network).
live(Study, measures(Pairs)) :-
    live(_, File, Case, Network),
    take_events(File),
    network_property(Network, hosts(Hosts)),
    findall(Event, event_seen(Event), Events),
    Log = log{case:Case, hosts:Hosts, events:Events},
    findall(Label-Number, measured(Study, Log, Label, Number), Pairs0),
    sort(1, @<, Pairs0, Pairs).
live(_, end) :-
    forall(retract(live(Directory, _, _, Network)),
           call_cleanup(network_stop(Network),
                        delete_directory_and_contents(Directory))),
    retractall(event_seen(_)),
    retractall(seen_to(_)).

given(Name-Value, Name-[Value]).

set_up(Study, Case0, Seed) :-
    tmp_file(study_live, Prefix),
    private_folder(Prefix, Directory),
    directory_file_path(Directory, 'events.pl', File),
    case_begins(Study, Case0, Seed, File, Case),
    study_network(Study, Case, log(File), Network),
    assertz(live(Directory, File, Case, Network)),
    assertz(seen_to(0)).

                /*******************************
                *          PARAMETERS          *
                *******************************/

%   choice(+Why, +Given, -Value, -Range) is semidet: fails for parameters that
%   people cannot choose.

choice(varied, Values, First, Range) =>
    Values = [First|_],
    range_of(Values, Range).
choice(sampled, Range0, Value, Range) =>
    sampled(Range0, Value, Range).
choice(default, _, _, _) =>
    fail.
choice(derived, _, _, _) =>
    fail.
choice(_, Given, Value, Range), number(Given) =>
    Value = Given,
    around(Given, Range).
choice(_, _, _, _) =>
    fail.

range_of(Values, range(From, To, Step)) :-
    forall(member(Value, Values), number(Value)),
    min_list(Values, From),
    max_list(Values, To),
    From < To,
    !,
    step(Values, From, To, Step).
range_of(Values, Values).

sampled(uniform(From, To), From, range(From, To, Step)) :- step([To], From, To, Step).
sampled(loguniform(From, To), From, range(From, To, Step)) :- step([0.5], From, To, Step).
sampled(integer(From, To), From, range(From, To, 1)).
sampled(Values, First, Range) :- Values = [First|_], range_of(Values, Range).

step(Values, _, _, 1) :-
    forall(member(Value, Values), integer(Value)),
    !.
step(_, From, To, Step) :-
    Step is (To-From)/100.0.

%   The greatest value is twice the one of the study.

around(Value, range(1, To, 1)) :-
    integer(Value),
    Value > 0,
    !,
    To is max(10, 2*Value).
around(Value, range(From, To, Step)) :-
    From is min(0, 2*Value),
    To is max(2*Value, 1)-min(0, Value),
    step([Value], From, To, Step).

                /*******************************
                *           MEASURES           *
                *******************************/

%   Also events that are not written to File yet.

take_events(File) :-
    log_size(File, _),
    retract(seen_to(Position0)),
    new_lines(File, Position0, Position, Lines),
    assertz(seen_to(Position)),
    forall(( member(Line, Lines),
             catch(term_string(Event, Line), error(_, _), fail),
             Event = event(_, _, _, _) ),
           assertz(event_seen(Event))).

%   A measure may have no value yet, or raise an error, as for a mean of nothing.

measured(Study, Log, Label, Number) :-
    catch(study_view(Study, Log, View), error(_, _), fail),
    findall(Name, clause(Study:measure(Name, _, _), _), Names0),
    list_to_set(Names0, Names),
    member(Name, Names),
    catch(study_call(Study, measure(Name, View, Number)), error(_, _), fail),
    number(Number),
    label(Study, Name, Label).

label(Study, Name, Label) :-
    (   study_call(Study, label(Name, Text))
    ->  Label = Text
    ;   Label = Name
    ).

:- multifile prolog:error_message//1.

prolog:error_message(study_skips(Given)) -->
    [ 'The study skips the case ~p'-[Given] ].
