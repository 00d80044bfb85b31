:- module(typhon_story,
          [ story/2                     % +File, +Agent
          ]).
:- use_module(library(apply), [include/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../../prolog/typhon', [log_events/2]).
:- use_module('../../prolog/typhon/kernel/base/text', [format_shown/2]).
:- use_module('../../prolog/typhon/tools/event_text',
              [event_lines/3, short_name/2]).

/** <module> The history of an agent, from a log

*Threading*: any thread.
*/

%!  story(+File, +Agent) is det.
%
%   Prints the events of Agent as text, in the order of the log File. Agent is
%   an id, the part of an id before `@`, or the name in it; if several agents
%   have that name, the story of each is printed.
%
%   @error typhon_usage(not_in_log(Agent, File, Names)): Names are in File

story(File, Agent) :-
    log_events(File, Events),
    findall(Id, ( member(event(_, _, Id, _), Events), is_called(Id, Agent) ),
            Ids0),
    sort(Ids0, Ids),
    (   Ids == []
    ->  nothing_of(Agent, File, Events)
    ;   forall(member(Id, Ids), print_story(Id, Events))
    ).

nothing_of(Agent, File, Events) :-
    findall(Name, ( member(event(_, _, Id, _), Events), short_name(Id, Name) ),
            Names0),
    sort(Names0, Names),
    throw(error(typhon_usage(not_in_log(Agent, File, Names)), _)).

is_called(Id, Agent) :-
    (   Id == Agent
    ;   short_name(Id, Short),
        (   Short == Agent
        ;   sub_atom(Short, Before, _, _, '.'),
            sub_atom(Short, 0, Before, _, Agent)
        )
    ),
    !.

print_story(Id, Events) :-
    include(of_agent(Id), Events, Own),
    Own = [event(Start, _, _, _)|_],
    (   Start > 100 000 000             % times of day are hard to read
    ->  Zero = Start
    ;   Zero = 0
    ),
    format_shown('~w~n', [Id]),
    forall(member(Event, Own), print_event(Event, Id, Zero)),
    nl.

of_agent(Id, event(_, _, Id, _)).
of_agent(Id, event(_, _, _, cloned(Id))).

print_event(event(Time, Host, Subject, What), Id, Zero) :-
    short_name(Host, Where),
    text(Subject, Id, What, Text),
    Shown is Time-Zero,
    format_shown('~t~4f~12|  ~w~t~12+ ~w~n', [Shown, Where, Text]).

text(Id, Id, What, Text) :-
    !,
    phrase(event_lines(What), Parts),
    message_text(Parts, Text).
text(Parent, _, cloned(_), Text) :-
    short_name(Parent, Short),
    format(string(Text), 'is a clone of ~w', [Short]).

message_text(Parts, Text) :-
    with_output_to(string(Text0),
                   print_message_lines(current_output, '', Parts)),
    split_string(Text0, "", "\n ", [Text]).
