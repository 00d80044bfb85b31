:- module(typhon_page_protocol,
          [ event_row/2,                % +Event, -Row
            skipped_row/2,              % +Count, -Row
            scene_dict/3,               % +Time, +Scene, -Dict
            agent_summary_dict/2,       % +Agent, -Dict
            text/2,                     % +Term, -Text
            name_text/2,                % +Atomic, -Text
            place_text/2,               % +Place, -Text
            number_json/2,              % +Number, -Json
            times_stop/0,
            times_of/1,                 % +Hosts
            page_time/2,                % +Stamp, -Time
            page_time/3                 % +Host, +HostTime, -Time
          ]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/error_text', [abridged/3]).
:- use_module('../../kernel/host', [address_parts/3]).

/** <module> The protocol of server and browser

Over a WebSocket at `feed` the server sends events in JSON, at most twenty times
a second; the browser sends nothing there.  The first message is

    {"snapshot": {"time": T, "read_only": B, "orders": [Name, ...],
                  "hosts": [Host, ...],
                  "agents": [Agent, ...], "overlays": [Overlay, ...],
                  "world": B}}

    Host:  {"id": Address, "process": Endpoint, "machine": Interface,
            "state": "running", "load": N, "capacity": N or absent,
            "arrived": N, "links": [[Address, Cost], ...]}
    Agent: {"id": Id, "host": Address, "program": Name, "status": Word,
            "doing": Text, "hops": N, "mail": N}

where the state of a host whose process has ended or is silent is `lost`.  A
host of a fleet whose process is silent is `away`; it has also "since", as of
get_time/1, and "parked", the number of agents and messages that wait for its
process.  Then
lists of events follow; their arguments are texts, except numbers:

    {"events": [[Time, Host, Agent, Kind, Argument ...], ...]}

      | created  | Program, where it is known |
      | left     | To                         |
      | stayed   | To                         |
      | arrived  | From, Seconds              |
      | cloned   | Id                         |
      | sent     | To                         |
      | received | From                       |
      | ended    | Outcome                    |
      | fault    | Text                       |
      | log      | Text                       |
      | link     | Host, Cost                 |
      | unlink   | Host                       |
      | leave    | Fact                       |
      | take     | Fact                       |
      | started, stopped, lost, back |        |
      | away     | Since, Parked              |
      | refused  | Agent, Reason              |
      | skipped  | Count                      |
      | show, add | Overlay, Where, Value     |

and every few seconds, when there is nothing else to send, {"tick": Time}, so
that a browser notices when the server is gone.

The browser posts requests to `ask`: {"ask": What, ...} for queries and
{"do": What, ...} for orders; the answer is {"answer": ...} or {"error": Text}.
The modules `queries` and `browser_orders` have a clause for each What.

*Threading*: any thread; a mutex serialises those that note clocks.
*/

%   Longer texts of terms are abridged.

longest(2000).

%!  event_row(+Event, -Row:list) is det.
%
%   Row is the form for the browser of Event, event(Time, Host, Agent, What) as
%   in watch/3.

event_row(event(Time, Host, Agent, What),
          [PageTime, HostText, AgentText, Kind|Arguments]) :-
    page_time(Host, Time, PageTime),
    name_text(Host, HostText),
    name_text(Agent, AgentText),
    what_row(What, Kind, Arguments).

what_row(arrived(From, Seconds), Kind, Arguments) =>
    Kind = "arrived",
    name_text(From, Text),
    Arguments = [Text, Seconds].
what_row(fault(fault(Error, Goal, Place, Host)), Kind, Arguments) =>
    Kind = "fault",
    place_short(Place, Short),
    text(fault(Error, Goal, Short, Host), Text),
    Arguments = [Text].
what_row(skipped(Count), Kind, Arguments) =>
    Kind = "skipped",
    Arguments = [Count].
what_row(What, Kind, Arguments) =>
    name_and_arguments(What, Name, Terms),
    atom_string(Name, Kind),
    maplist(argument_text, Terms, Arguments).

name_and_arguments(What, Name, Terms) :-
    (   compound(What)
    ->  compound_name_arguments(What, Name, Terms)
    ;   Name = What,
        Terms = []
    ).

argument_text(Term, Text) :-
    (   number(Term)
    ->  number_json(Term, Text)
    ;   atom(Term)
    ->  name_text(Term, Text)
    ;   text(Term, Text)
    ).

%!  place_text(+Place, -Text:string) is det.
%
%   Text is the Place of a fault, see agent_property/2, without the folder of
%   the file, which may be that of the editor, or of another machine.

place_text(Place, Text) :-
    place_short(Place, Short),
    (   Short = Name:Line,
        integer(Line),
        atom(Name)
    ->  format(string(Text), '~w:~d', [Name, Line])
    ;   text(Short, Text)
    ).

place_short(File:Line, Short), atom(File) =>
    file_base_name(File, Name),
    Short = Name:Line.
place_short(Place, Short) =>
    Short = Place.

%!  skipped_row(+Count:integer, -Row:list) is det.
%
%   Row reports to one browser that it misses Count events.

skipped_row(Count, [null, "", "", "skipped", Count]).

%!  name_text(+Atomic, -Text:string) is det.
%!  text(+Term, -Text:string) is det.
%
%   Text shows an id or an address unchanged, and another term as Prolog writes
%   it; for `none`, the agent of events without agents, it is empty.

name_text(none, Text) =>
    Text = "".
name_text(Name, Text), atomic(Name) =>
    atom_string(Name, Text).
name_text(Term, Text) =>
    text(Term, Text).

text(Term, Text) :-
    longest(Longest),
    abridged(Term, Longest, Text).

%!  number_json(+Number, -Json) is det.
%
%   Json is Number, or a text for an infinite number or NaN, which JSON lacks.

number_json(Number, Json) :-
    (   float(Number),
        float_class(Number, Class),
        memberchk(Class, [infinite, nan])
    ->  text(Number, Json)
    ;   Json = Number
    ).

                /*******************************
                *            SCENES            *
                *******************************/

%!  scene_dict(+Time, +Scene, -Dict) is det.
%
%   Dict is a snapshot at Time of Scene, scene(Hosts, Agents): terms host/8 and
%   agent(Id, Summary), see inventory/4.

scene_dict(Time, scene(Hosts, Agents),
           _{time:Time, hosts:HostDicts, agents:AgentDicts}) :-
    maplist(host_dict, Hosts, HostDicts),
    maplist(agent_summary_dict, Agents, AgentDicts).

host_dict(host(Address, State, Load, Capacity, Arrived, Neighbours, Costs,
               _),
          Dict) :-
    address_parts(Address, _, Endpoint),
    machine(Endpoint, Machine),
    maplist(link_row, Neighbours, Costs, Links),
    state_shown(State, Shown, More),
    maplist(name_text, [Address, Endpoint, Machine, Shown],
            [Id, Process, On, StateText]),
    Dict0 = _{id:Id, process:Process, machine:On, state:StateText,
              load:Load, arrived:Arrived, links:Links},
    (   integer(Capacity)
    ->  Dict = Dict0.put(capacity, Capacity)
    ;   Dict = Dict0.put(More)
    ).

state_shown(gone, lost, _{}) :- !.
state_shown(silent, lost, _{}) :- !.
state_shown(away(Since, Parked), away, _{since:Since, parked:Parked}) :- !.
state_shown(State, State, _{}).

machine(Endpoint, Machine) :-
    (   sub_atom(Endpoint, Before, _, After, :),
        \+ ( sub_atom(Endpoint, _, After, 0, Port),
             sub_atom(Port, _, _, _, :) )
    ->  sub_atom(Endpoint, 0, Before, _, Machine)
    ;   Machine = Endpoint
    ).

link_row(Neighbour, Cost, [Text, Json]) :-
    name_text(Neighbour, Text),
    number_json(Cost, Json).

%!  agent_summary_dict(+Agent, -Dict) is det.
%
%   Agent is agent(Id, Summary), see agent_summary/2.

agent_summary_dict(agent(Id, glance(Host, Program, Doing, Hops, Mail)), Dict) :-
    maplist(name_text, [Id, Host, Program, Doing],
            [IdText, HostText, ProgramText, DoingText]),
    status_word(DoingText, Status),
    Dict = _{id:IdText, host:HostText, program:ProgramText, status:Status,
             doing:DoingText, hops:Hops, mail:Mail}.

status_word(Doing, Word) :-
    split_string(Doing, " ,:", "", [Word|_]).

                /*******************************
                *             TIME             *
                *******************************/

:- dynamic
    reference/2,                % Epoch, Rate
    clock_of/3.                 % Host, Epoch, Rate

%!  times_stop is det.

times_stop :-
    retractall(reference(_, _)),
    retractall(clock_of(_, _, _)).

%!  times_of(+Hosts) is det.
%
%   Note the clocks of Hosts, terms host/8 of inventory_hosts/4.

times_of(Hosts) :-
    with_mutex(typhon_page_protocol,
               ( forall(member(Host, Hosts), note_clock(Host)),
                 choose_reference(Hosts) )).

note_clock(host(Address, _, _, _, _, _, _, clock(Epoch, Rate))) =>
    (   clock_of(Address, Epoch, Rate)
    ->  true
    ;   retractall(clock_of(Address, _, _)),
        assertz(clock_of(Address, Epoch, Rate))
    ).
note_clock(_) =>
    true.

%   A host without a network has the time of day, which has too many digits to
%   show, so the page has an origin of its own.  Virtual time is not converted.

choose_reference(_) :-
    reference(_, _),
    !.
choose_reference(Hosts) :-
    memberchk(host(_, _, _, _, _, _, _, virtual), Hosts),
    !.
choose_reference(_) :-
    clock_of(_, Epoch, Rate),
    Epoch > 0,
    !,
    assertz(reference(Epoch, Rate)).
choose_reference(_) :-
    monotonic_time(Now),
    assertz(reference(Now, 1)).

%!  page_time(+Stamp, -Time) is det.
%!  page_time(+Host, +HostTime, -Time) is det.
%
%   Time is the time of the page, in seconds: at Stamp, a monotonic_time/1, or
%   when the clock of Host, an address, shows HostTime.  With
%   virtual time no time of the page belongs to Stamp: page_time/2 gives `null`.

page_time(Stamp, Time) :-
    reference(Epoch, Rate),
    !,
    Time is (Stamp-Epoch)*Rate.
page_time(_, null).

page_time(_, none, null) :-             % of a fleet
    !.
page_time(Host, HostTime, Time) :-
    reference(Epoch, Rate),
    clock_of(Host, Epoch1, Rate1),
    ( Epoch1 =\= Epoch ; Rate1 =\= Rate ),
    !,
    Time is (Epoch1+HostTime/Rate1-Epoch)*Rate.
page_time(_, Time, Time).
