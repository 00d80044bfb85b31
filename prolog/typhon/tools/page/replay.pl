:- module(typhon_page_replay,
          [ replay_of_text/3,           % +Title, +Text, -Dict
            replay_export/3             % +LogFile, +File, +Options
          ]).
:- use_module(library(apply), [foldl/5, maplist/3]).
:- use_module(library(assoc), [empty_assoc/1, get_assoc/3, put_assoc/4]).
:- use_module(library(base64), [base64_encoded/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sgml), [xml_quote_cdata/3]).
:- use_module(library(sha), [sha_hash/3]).
:- use_module('../../bridges/json', [json_text/2]).
:- use_module('../../kernel/base/private', [output_file/2]).
:- use_module('../../network', [log_events/2]).
:- use_module('../../tools', [own_event/1]).
:- use_module(guard, [page_file/3]).
:- use_module(overlays, [event_rows/3, overlay_dicts/2, overlays_declared/2]).
:- use_module(protocol, [name_text/2]).

/** <module> Logs in the form in which the page replays them

    {"title": Text, "names": [Text, ...],
     "snapshot": {"hosts": [{"id": Address, "links": [[Address, 1], ...]}]},
     "overlays": [{"name": Title, "kind": Kind}, ...],
     "events": [[Time, Host, Agent, Kind, Argument ...], ...]}

where texts in events are indexes into `names`, since ids are frequent, and
numbers are in lists of length one.  A log contains links only if they were made
or broken while it was written; if it contains none, the replay links the hosts
between which an agent hopped.

An exported file needs no server and fetches nothing: it contains scripts,
styles and the log.  Modules are data URLs, named by an import map, so an import
from `./x.js` becomes one from `typhon/x.js`.  The Content-Security-Policy
allows only the scripts that were written into the file.

*Threading*: any thread.
*/

%   replay_dict(+LogFile, +Options, -Dict) is det.
%
%   Dict is the log LogFile as above.  Options: title(Text), default the name of
%   the file; overlays(Files), files whose overlays are shown besides those of
%   the programs in agents/.
%
%   @error existence_error(source_sink, File)

replay_dict(LogFile, Options, Dict) :-
    log_events(LogFile, Logged),
    file_base_name(LogFile, Base),
    option(title(Title0), Options, Base),
    option(overlays(Files), Options, []),
    overlays_declared(Files, Declared),
    maplist(logged_event, Logged, Events),
    event_rows(Events, Declared, Rows),
    used_overlays(Rows, Declared, Used),
    overlay_dicts(Used, Overlays),
    hosts(Events, Hosts),
    intern(Rows, Names, Short),
    name_text(Title0, Title),
    Dict = _{ title:Title, names:Names, overlays:Overlays,
              snapshot:_{hosts:Hosts, agents:[]}, events:Short }.

%!  replay_of_text(+Title, +Text, -Dict) is det.
%
%   As replay_dict/3, for the text of a log that a browser sends.

replay_of_text(Title, Text, Dict) :-
    setup_call_cleanup(
        tmp_file_stream(File, Out, [encoding(utf8)]),
        ( write(Out, Text),
          close(Out),
          replay_dict(File, [title(Title)], Dict) ),
        ( close(Out, [force(true)]),
          delete_file(File) )).

%   logged_event(+Logged, -Event): Event is the event Logged in the form of
%   watch/3.

logged_event(event(Time, Host, Agent, What), event(Time, Host, Agent, Shown)) :-
    shown_event(What, Shown).

shown_event(faulty(Error), Shown) => Shown = fault(Error).
shown_event(fault(Fault), Shown) => Shown = fault(Fault).
shown_event(What, Shown), own_event(What) => Shown = What.
shown_event(What, Shown), of_network(What) => Shown = What.
shown_event(Term, Shown) => Shown = log(Term).

of_network(link(Other, Cost)) :- is_address(Other), number(Cost).
of_network(lost).

is_address(Address) :-
    atom(Address),
    sub_atom(Address, _, _, _, @),
    !.

%   used_overlays(+Rows, +Declared, -Used): Used are the overlays of Declared
%   with a row.  No other row has three arguments.

used_overlays(Rows, Declared, Used) :-
    findall(Overlay,
            ( member(Overlay, Declared),
              arg(1, Overlay, Title),
              name_text(Title, Text),
              memberchk([_, _, _, _, Text, _, _], Rows) ),
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
    ->  Links = []                      % the events have them
    ;   findall(From-To,
                ( member(event(_, Here, _, arrived(There, _)), Events),
                  Here \== There,
                  is_address(There),
                  ( From-To = Here-There ; From-To = There-Here ) ),
                Links0),
        sort(Links0, Links)
    ).

%   intern(+Rows, -Names, -Short): Short are Rows with indexes into Names in
%   place of texts, so that each text is sent once.

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

                /*******************************
                *           ONE FILE           *
                *******************************/

:- multifile prolog:error_message//1.

style('views.css').
style('uPlot.min.css').

library('d3-dispatch.min.js').
library('d3-quadtree.min.js').
library('d3-timer.min.js').
library('d3-force.min.js').
library('uPlot.iife.min.js').

%!  replay_export(+LogFile, +File, +Options) is det.
%
%   Write a page that replays LogFile.  Options are those of replay_dict/3.
%
%   @error existence_error(source_sink, LogFile), permission_error(open,
%   source_sink, File)
%   @error existence_error(log_events, LogFile): there are none in it
%   @error permission_error(overwrite, page, File): File is no such page
%   @error existence_error(page_tool, Name) before `make page-tools`

replay_export(LogFile, File, Options) :-
    output_file(page, File),
    replay_dict(LogFile, Options, Replay),
    (   Replay.events == []
    ->  existence_error(log_events, LogFile)
    ;   true
    ),
    findall(Part, part(Replay, Part), Parts),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8), newline(posix)]),
        write_page(Out, Replay.title, Parts),
        close(Out)).

%   part(+Replay, -Part): style(Text), data(Text) or script(Type, Text).

part(_, style(Text)) :-
    style(Name),
    file_text(Name, Text).
part(_, style("html, body { margin: 0; height: 100%; \c
               background: var(--view-bg); color: var(--view-text); }")).
part(Replay, data(Text)) :-
    json_text(Replay, Json),
    without_tags(Json, Text).
part(_, script('text/javascript', Text)) :-
    library(Name),
    file_text(Name, Text).
part(_, script(importmap, Text)) :-
    modules(['replay.js'], [], Modules),
    maplist(module_pair, Modules, Pairs),
    dict_pairs(Imports, _, Pairs),
    json_text(_{imports:Imports}, Text).
part(_, script(module,
               "import { showReplay } from 'typhon/replay.js';\n\c
                const text = document.getElementById('replay').textContent;\n\c
                globalThis.typhon = showReplay(document.body, \c
                JSON.parse(text));")).

file_text(Name, Text) :-
    (   page_file([Name], File, _)
    ->  read_file_to_string(File, Text, [encoding(utf8)])
    ;   existence_error(page_tool, Name)
    ).

%   modules(+Files, +Known0, -Known): Known are pairs File-Text for Files, and
%   the files that they import, besides Known0.

modules([], Known, Known).
modules([File|Files], Known, Modules) :-
    memberchk(File-_, Known),
    !,
    modules(Files, Known, Modules).
modules([File|Files], Known, Modules) :-
    file_text(File, Text),
    findall(Imported, imported(Text, Imported), New),
    append(New, Files, More),
    modules(More, [File-Text|Known], Modules).

imported(Text, File) :-
    sub_string(Text, _, _, After, "from './"),
    sub_string(Text, _, After, 0, Rest),
    once(sub_string(Rest, Length, _, _, "'")),
    sub_atom(Rest, 0, Length, _, File).

module_pair(File-Text, Name-Address) :-
    replaced(Text, "from './", "from 'typhon/", Rewritten),
    base64_encoded(Rewritten, Encoded, [encoding(utf8), as(string)]),
    atom_concat('typhon/', File, Name),
    string_concat("data:text/javascript;base64,", Encoded, Address).

%   Text of agents must not be able to end the script element.

without_tags(Json, Text) :-
    replaced(Json, "<", "\\u003c", Text).

replaced(Text0, Old, New, Text) :-
    atomic_list_concat(Parts, Old, Text0),
    atomic_list_concat(Parts, New, Text1),
    atom_string(Text1, Text).

                /*******************************
                *             HTML             *
                *******************************/

write_page(Out, Title, Parts) :-
    findall(Source, script_source(Parts, Source), Sources),
    atomic_list_concat(Sources, ' ', Scripts),
    xml_quote_cdata(Title, Quoted, utf8),
    format(Out, '<!doctype html>~n<html lang="en">~n<head>~n\c
                 <meta charset="utf-8">~n\c
                 <meta http-equiv="Content-Security-Policy" content="\c
                 default-src \'none\'; style-src \'unsafe-inline\'; \c
                 img-src data: blob:; script-src data: ~w">~n\c
                 <meta name="viewport" \c
                 content="width=device-width, initial-scale=1">~n\c
                 <title>~w</title>~n', [Scripts, Quoted]),
    forall(member(style(Text), Parts),
           format(Out, '<style>~s</style>~n', [Text])),
    format(Out, '</head>~n<body>~n', []),
    forall(member(Part, Parts), write_script(Out, Part)),
    format(Out, '</body>~n</html>~n', []).

script_source(Parts, Source) :-
    member(script(_, Text), Parts),
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(utf8)]),
    string_codes(Binary, Bytes),
    base64_encoded(Binary, Hash, [encoding(octet), as(atom)]),
    format(atom(Source), '\'sha256-~w\'', [Hash]).

write_script(Out, data(Text)) :-
    format(Out, '<script type="application/json" id="replay">~s</script>~n',
           [Text]).
write_script(Out, script(Type, Text)) :-
    format(Out, '<script type="~w">~s</script>~n', [Type, Text]).
write_script(_, style(_)).

prolog:error_message(existence_error(page_tool, Name)) -->
    [ '~w is missing; run `make page-tools` to get it'-[Name] ].
