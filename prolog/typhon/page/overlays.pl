:- module(typhon_page_overlays,
          [ overlays_in/2,              % +File, -Overlays
            overlays_of_agents/1,       % -Overlays
            overlay_rows/3,             % +Overlays, +Event, -Rows
            overlay_dicts/2             % +Overlays, -Dicts
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [append/2, member/2]).
:- use_module(protocol, [name_text/2, text/2]).

/** <module> What mechanisms show of themselves on a map

An agent program, or the file of a study, declares it with facts

    overlay(Title, Kind, When, Value).

When something happens that unifies with When, which is log(Term),
leave(Fact) or take(Fact), Value is shown on the host where it happened:

  - a number or another term: that; `none` ends what is shown
  - Host-Term: Term on Host
  - (A,B)-Term: Term on the link of A and B, if Kind is `link`
  - add(N), Host-add(N): the sum of such numbers

Kind is `bar` for numbers that are compared, `label` for words, `colour` for
words that stand for kinds, `link` for what belongs to links.  These facts are
read as data, never called: the file is not loaded for them, and agents that
have them do nothing with them.

*Threading*: any thread.
*/

%!  overlays_in(+File, -Overlays:list) is det.
%
%   The facts overlay/4 of File, not of files that it includes.  Terms that
%   cannot be read are passed over.
%
%   @error existence_error(source_sink, File)

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

%!  overlays_of_agents(-Overlays:list) is det.
%
%   Those of all files below the folders of the search path `agents`.

overlays_of_agents(Overlays) :-
    findall(Own,
            ( absolute_file_name(agents('.'), Folder,
                                 [ file_type(directory), access(read),
                                   solutions(all), file_errors(fail) ]),
              directory_member(Folder, File,
                               [extensions([pl]), recursive(true)]),
              overlays_in(File, Own) ),
            All),
    append(All, Overlays).

%!  overlay_dicts(+Overlays, -Dicts:list) is det.
%
%   What the page has to know of them: each title once.

overlay_dicts(Overlays, Dicts) :-
    findall(Title-Kind, member(overlay(Title, Kind, _, _), Overlays), Known),
    sort(1, @<, Known, Titles),
    maplist(overlay_dict, Titles, Dicts).

overlay_dict(Title-Kind, _{name:Name, kind:KindText}) :-
    maplist(name_text, [Title, Kind], [Name, KindText]).

%!  overlay_rows(+Overlays, +Event, -Rows:list) is det.
%
%   Rows are those that tell what Event, as of watch/3, changes:
%   [Time, Host, Agent, "show" or "add", Title, Where, Value].

overlay_rows(Overlays, event(Time, Host, Agent, What), Rows) :-
    findall([Time, HostText, AgentText, Kind, Name, Where, Shown],
            ( member(overlay(Title, _, What, Value), Overlays),
              shown(Value, Host, Kind, Where, Shown),
              maplist(name_text, [Host, Agent, Title],
                      [HostText, AgentText, Name]) ),
            Rows).

shown(Value, Host, Kind, Where, Shown) :-
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

value(none, "show", null) :- !.
value(Number, "show", Number) :- number(Number), !.
value(add(Number), "add", Number) :- number(Number), !.
value(Term, "show", Text) :- text(Term, Text).
