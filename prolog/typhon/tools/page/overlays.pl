:- module(typhon_page_overlays,
          [ overlays_start/1,           % +Files
            overlays_stop/0,
            overlays_shown/1,           % -Dicts
            overlays_declared/2,        % +Files, -Overlays
            event_rows/2,               % +Events, -Rows
            event_rows/3,               % +Events, +Overlays, -Rows
            overlay_dicts/2             % +Overlays, -Dicts
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(protocol, [event_row/2, name_text/2, number_told/2, text/2]).

/** <module> What mechanisms show of themselves on a map

An agent program, or the file of a study, declares it with facts

    overlay(Title, Kind, When, Value).

When something happens that is an instance of When, which is log(Term),
leave(Fact) or take(Fact), Value is shown on the host where it happened:

  - a number or another term: that; `none` ends what is shown
  - Host-Term: Term on Host
  - (A,B)-Term: Term on the link of A and B, if Kind is `link`
  - add(N), Host-add(N): the sum of such numbers

Kind is `bar` for numbers that are compared, `label` for words, `colour` for
words that stand for kinds, `link` for what belongs to links.  These facts are
read as data, never called: the file is not loaded for them, and agents that
have them do nothing with them.

*Threading*: starting and stopping are done by one thread at a time; any
thread asks.
*/

:- dynamic shown/1.                     % what a page that is served shows

%!  overlays_start(+Files) is det.
%!  overlays_stop is det.
%!  overlays_shown(-Dicts) is det.
%
%   While a page is served, it shows those of agents/ and of Files.

overlays_start(Files) :-
    overlays_declared(Files, Overlays),
    assertz(shown(Overlays)).

overlays_stop :-
    retractall(shown(_)).

overlays_shown(Dicts) :-
    (   shown(Overlays)
    ->  overlay_dicts(Overlays, Dicts)
    ;   Dicts = []
    ).

%!  overlays_declared(+Files, -Overlays:list) is det.
%
%   The facts overlay/4 in Files, and in all files below agents/; of each file
%   for itself, not of what it includes.  Terms that cannot be read are passed
%   over.
%
%   @error existence_error(source_sink, File)

overlays_declared(Files, Overlays) :-
    findall(File, declaring(Files, File), Found),
    sort(Found, All),
    maplist(overlays_in, All, Lists),
    append(Lists, Overlays).

declaring(Files, File) :-
    member(Given, Files),
    absolute_file_name(Given, File).
declaring(_, File) :-
    module_property(typhon_page_overlays, file(Here)),
    absolute_file_name('../../../../agents', Folder, [relative_to(Here)]),
    directory_member(Folder, File, [extensions([pl]), recursive(true)]).

overlays_in(File, Overlays) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        overlays_from(In, Overlays),
        close(In)).

overlays_from(In, Overlays) :-
    catch(read_term(In, Term, [module(typhon_page_overlays)]),
          error(syntax_error(_), _), Term = skipped),
    (   Term == end_of_file
    ->  Overlays = []
    ;   is_overlay(Term)
    ->  Overlays = [Term|Rest],
        overlays_from(In, Rest)
    ;   overlays_from(In, Overlays)
    ).

is_overlay(Term) :-
    nonvar(Term),
    Term = overlay(Title, Kind, When, _),
    atomic(Title),
    memberchk(Kind, [bar, label, colour, link]),
    nonvar(When),
    functor(When, Name, 1),
    memberchk(Name, [log, leave, take]).

%!  overlay_dicts(+Overlays, -Dicts:list) is det.
%
%   What the page has to know of them: each title once.

overlay_dicts(Overlays, Dicts) :-
    findall(Title-Kind, member(overlay(Title, Kind, _, _), Overlays), Known),
    sort(1, @<, Known, Titles),
    maplist(overlay_dict, Titles, Dicts).

overlay_dict(Title-Kind, _{name:Name, kind:KindText}) :-
    maplist(name_text, [Title, Kind], [Name, KindText]).

%!  event_rows(+Events, -Rows:list) is det.
%!  event_rows(+Events, +Overlays, -Rows:list) is det.
%
%   Events, as of watch/3, as they are sent to the browser; each is followed by
%   rows of what it changes in Overlays, those of the page that is served:
%   [Time, Host, Agent, "show" or "add", Title, Where, Value].

event_rows(Events, Rows) :-
    (   shown(Overlays)
    ->  true
    ;   Overlays = []
    ),
    event_rows(Events, Overlays, Rows).

event_rows([], _, []).
event_rows([Event|Events], Overlays, [Row|Rows]) :-
    event_row(Event, Row),
    arg(4, Event, What),
    (   may_show(What)
    ->  findall(Shown, overlay_row(Overlays, Event, Shown), More),
        append(More, Rest, Rows)
    ;   Rest = Rows
    ),
    event_rows(Events, Overlays, Rest).

may_show(log(_)).
may_show(leave(_)).
may_show(take(_)).

overlay_row(Overlays, event(Time, Host, Agent, What),
            [Time, HostText, AgentText, Kind, Name, Where, Shown]) :-
    member(overlay(Title, _, When, Value), Overlays),
    subsumes_term(When, What),
    When = What,
    value_at(Value, Host, Kind, Where, Shown),
    maplist(name_text, [Host, Agent, Title], [HostText, AgentText, Name]).

value_at(Value, Host, Kind, Where, Shown) :-
    (   nonvar(Value),
        Value = Place-Term
    ->  true
    ;   Place = Host,
        Term = Value
    ),
    place_text(Place, Where),
    value(Term, Kind, Shown).

place_text((A,B), Where) :-
    !,
    msort([A, B], [First, Second]),
    maplist(name_text, [First, Second], [FirstText, SecondText]),
    atomics_to_string([FirstText, " ", SecondText], Where).
place_text(Place, Where) :-
    name_text(Place, Where).

value(Term, Kind, Text), var(Term) => Kind = "show", text(Term, Text).
value(none, Kind, Value) => Kind = "show", Value = null.
value(Number, Kind, Value), number(Number) =>
    Kind = "show",
    number_told(Number, Value).
value(add(Number), Kind, Value), number(Number), number_told(Number, Number) =>
    Kind = "add",
    Value = Number.
value(Term, Kind, Text) => Kind = "show", text(Term, Text).
