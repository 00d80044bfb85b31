:- module(typhon_page_replay,
          [ replay_dict/3,              % +LogFile, +Options, -Dict
            replay_of_text/3            % +Title, +Text, -Dict
          ]).
:- use_module(library(apply), [foldl/5, maplist/3]).
:- use_module(library(assoc), [empty_assoc/1, get_assoc/3, put_assoc/4]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../../network', [log_events/2]).
:- use_module('../../tools', [own_event/1]).
:- use_module(overlays,
              [ event_rows/3, overlay_dicts/2, overlays_declared/2 ]).
:- use_module(protocol, [name_text/2]).

/** <module> Logs as the page replays them

    {"title": Text, "names": [Text, ...],
     "snapshot": {"hosts": [{"id": Address, "links": [[Address, 1], ...]}]},
     "overlays": [{"name": Title, "kind": Kind}, ...],
     "events": [[Time, Host, Agent, Kind, Argument ...], ...]}

where texts in events are numbers of `names`, and numbers stand in lists of
one: ids come again and again.  Which hosts are linked is in a log only if
links came or went; else hosts between which an agent hopped are taken for
linked.

*Threading*: any thread.
*/

%!  replay_dict(+LogFile, +Options, -Dict) is det.
%
%   Options: title(Text), default the name of the file; overlays(Files), whose
%   overlays are shown beside those of the programs in agents/.
%
%   @error existence_error(source_sink, File)

replay_dict(LogFile, Options, Dict) :-
    log_events(LogFile, Logged),
    file_base_name(LogFile, Base),
    option(title(Title0), Options, Base),
    option(overlays(Files), Options, []),
    overlays_declared(Files, Declared),
    maplist(watched, Logged, Events),
    event_rows(Events, Declared, Rows),
    used(Rows, Declared, Used),
    overlay_dicts(Used, Overlays),
    hosts(Events, Hosts),
    intern(Rows, Names, Short),
    name_text(Title0, Title),
    Dict = _{ title:Title, names:Names, overlays:Overlays,
              snapshot:_{hosts:Hosts, agents:[]}, events:Short }.

%!  replay_of_text(+Title, +Text, -Dict) is det.
%
%   The same of the text of a log, which a browser sends.

replay_of_text(Title, Text, Dict) :-
    setup_call_cleanup(
        tmp_file_stream(File, Out, [encoding(utf8)]),
        ( write(Out, Text),
          close(Out),
          replay_dict(File, [title(Title)], Dict) ),
        ( close(Out, [force(true)]),
          delete_file(File) )).

%   watched(+Logged, -Event): as watch/3 would tell it.

watched(event(Time, Host, Agent, What), event(Time, Host, Agent, Told)) :-
    told(What, Told).

told(faulty(Error), Told) => Told = fault(Error).
told(fault(Fault), Told) => Told = fault(Fault).
told(What, Told), own_event(What) => Told = What.
told(What, Told), of_network(What) => Told = What.
told(Term, Told) => Told = log(Term).

of_network(link(Other)) :- is_address(Other).
of_network(link(Other, Cost)) :- is_address(Other), number(Cost).
of_network(unlink(Other)) :- is_address(Other).
of_network(started).
of_network(stopped).
of_network(lost).

is_address(Address) :-
    atom(Address),
    sub_atom(Address, _, _, _, @),
    !.

%   used(+Rows, +Declared, -Used): those overlays that show something.

used(Rows, Declared, Used) :-
    findall(Title,
            ( member([_, _, _, Kind, Title|_], Rows),
              memberchk(Kind, ["show", "add"]) ),
            Titles0),
    sort(Titles0, Titles),
    findall(Overlay,
            ( member(Overlay, Declared),
              arg(1, Overlay, Title),
              name_text(Title, Text),
              memberchk(Text, Titles) ),
            Used).

                /*******************************
                *        HOSTS AND LINKS       *
                *******************************/

hosts(Events, Dicts) :-
    findall(Host, ( member(Event, Events), event_host(Event, Host) ), Hosts0),
    sort(Hosts0, Hosts),
    links(Events, Links),
    findall(_{id:Id, links:Rows},
            ( member(Host, Hosts),
              name_text(Host, Id),
              findall([Other, 1],
                      ( member(Host-Name, Links), name_text(Name, Other) ),
                      Rows) ),
            Dicts).

event_host(event(_, Host, _, _), Host) :-
    is_address(Host).
event_host(event(_, _, _, What), Host) :-
    other_host(What, Host),
    is_address(Host).

other_host(left(Host), Host).
other_host(arrived(Host, _), Host).
other_host(link(Host), Host).
other_host(link(Host, _), Host).

links(Events, Links) :-
    (   member(event(_, _, none, Link), Events),
        functor(Link, link, _)
    ->  Links = []                      % and told as they come
    ;   findall(From-To,
                ( member(event(_, Here, _, arrived(There, _)), Events),
                  Here \== There,
                  is_address(There),
                  ( From-To = Here-There ; From-To = There-Here ) ),
                Links0),
        sort(Links0, Links)
    ).

                /*******************************
                *             NAMES            *
                *******************************/

%   intern(+Rows, -Names, -Short): texts are sent once.

intern(Rows, Names, Short) :-
    empty_assoc(Known),
    foldl(short_row, Rows, Short, state(0, Known, Names), state(_, _, [])).

short_row([Time|Items], [Time|Short], State0, State) :-
    foldl(short, Items, Short, State0, State).

short(Number, [Number], State, State) :-
    number(Number),
    !.
short(null, null, State, State) :- !.
short(Text, Index, state(Next, Known, Names), State) :-
    get_assoc(Text, Known, Index),
    !,
    State = state(Next, Known, Names).
short(Text, Next, state(Next, Known0, [Text|Names]),
      state(After, Known, Names)) :-
    put_assoc(Text, Known0, Next, Known),
    After is Next+1.
