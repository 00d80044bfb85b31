:- module(typhon_page_overlays,
          [ overlays_start/1,           % +Files
            overlays_stop/0,
            overlays_shown/1,           % -Dicts
            overlays_declared/2,        % +Files, -Overlays
            event_rows/2,               % +Events, -Rows
            event_rows/3,               % +Events, +Overlays, -Rows
            overlay_dicts/2,            % +Overlays, -Dicts
            mechanism_dicts/1,          % -Dicts
            mechanism_operator/2,       % +Name, -Module
            mechanism_parameters/3,     % +Name, +Predicate, -Dicts
            program_names/1             % -Names
          ]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3, partition/4]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(prolog_source),
              [ prolog_close_source/1, prolog_open_source/2,
                prolog_read_source_term/4 ]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(models, [parameter_dict/2]).
:- use_module(protocol, [event_row/2, name_text/2, number_json/2, text/2]).
:- use_module('../../kernel/program', []).        % where agents(Name) is found

/** <module> Overlays and mechanisms: what the page reads in agents/

An agent program, or the file of a study, declares what the map shows by facts

    overlay(Title, Kind, When, Value).

When is log(Term), leave(Fact) or take(Fact).  When an event happens that is an
instance of it, the page shows Value on the host of the event:

  - a number or another term: this; `none` removes the value
  - Host-Term: Term on Host
  - (A,B)-Term: Term on the link of A and B, if Kind is `link`
  - add(N), Host-add(N): the sum of such numbers

Kind is `bar` for numbers to compare, `label` for words, `colour` for words that
denote kinds, `link` for values of links.  The page reads these facts as data,
and neither loads the file nor calls them; agents do not use them either.

The operator of a mechanism is the module by which users control it.  The page
reads the arguments of its predicates from their comments, and has their settings
from parameter/3, so that it knows no mechanism by name.

*Threading*: one thread at a time starts and stops; any thread queries.  Each
query reads the files again.
*/

:- dynamic shown/1.                     % overlays of the page that is served

:- multifile
    parameter/3.                % Predicate, Parameter, About: a setting that Predicate
                                % takes, parameter(Name, Value, Range) as of a model

%!  overlays_start(+Files) is det.
%!  overlays_stop is det.
%!  overlays_shown(-Dicts) is det.
%
%   Show the overlays of agents/ and of Files from now on, and show them no
%   longer; Dicts describe those that are shown.

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
%   Overlays are the facts overlay/4 in Files, and in all files below agents/,
%   but not in files that these include.  Terms that cannot be read are skipped.
%   Most files have none, and are not read as terms.
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
    read_file_to_string(File, Text, [encoding(utf8)]),
    (   sub_string(Text, _, _, _, "overlay(")
    ->  setup_call_cleanup(
            open_string(Text, In),
            overlays_from(In, Overlays),
            close(In))
    ;   Overlays = []
    ).

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
%   Dicts describe Overlays for the browser, each title once.

overlay_dicts(Overlays, Dicts) :-
    findall(Title-Kind, member(overlay(Title, Kind, _, _), Overlays), Known),
    sort(1, @<, Known, Titles),
    maplist(overlay_dict, Titles, Dicts).

overlay_dict(Title-Kind, _{name:Name, kind:KindText}) :-
    maplist(name_text, [Title, Kind], [Name, KindText]).

%!  event_rows(+Events, -Rows:list) is det.
%!  event_rows(+Events, +Overlays, -Rows:list) is det.
%
%   Rows are Events, see watch/3, in the form for the browser.  The row of an
%   event is followed by rows for what it changes in Overlays, by default those
%   that the page shows: [Time, Host, Agent, "show" or "add", Title, Where,
%   Value].

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
    number_json(Number, Value).
value(add(Number), Kind, Value), number(Number), number_json(Number, Number) =>
    Kind = "add",
    Value = Number.
value(Term, Kind, Text) => Kind = "show", text(Term, Text).

                /*******************************
                *          MECHANISMS          *
                *******************************/

%!  program_names(-Names:list(string)) is det.
%
%   Names are the agent programs in the folders agents(.), in the form
%   agents(Name).

program_names(Names) :-
    findall(Name, program_name(Name), Names0),
    sort(Names0, Names).

program_name(Name) :-
    folder(Dir),
    directory_member(Dir, File, [extensions([pl]), recursive(true)]),
    is_program(File),
    atom_concat(Dir, Below, File),
    atom_concat(/, Relative, Below),
    file_name_extension(Base, _, Relative),
    atomic_list_concat([First|Parts], /, Base),
    foldl([Part,Begin,Begin/Part]>>true, Parts, First, Path),
    format(string(Name), 'agents(~q)', [Path]).

folder(Dir) :-
    absolute_file_name(agents(.), Dir,
                       [ file_type(directory), solutions(all),
                         file_errors(fail) ]).

%   The first term of an agent program is its declaration.

is_program(File) :-
    catch(setup_call_cleanup(
              open(File, read, In, [encoding(utf8)]),
              read_term(In, Term, []),
              close(In)),
          error(_, _), fail),
    nonvar(Term),
    Term = (:- Declaration),
    nonvar(Declaration),
    functor(Declaration, agent, Arity),
    memberchk(Arity, [1,2]).

%!  mechanism_operator(+Name, -Module) is det.
%
%   Module is the operator of the mechanism Name, which is loaded.
%
%   @error existence_error(mechanism, Name)

mechanism_operator(Name, Module) :-
    (   mechanism_file(Name, File)
    ->  load_files(File, [if(not_loaded), imports([])]),
        module_property(Module, file(File))
    ;   existence_error(mechanism, Name)
    ).

%!  mechanism_parameters(+Name, +Predicate, -Dicts) is det.
%
%   Dicts are _{name, value, about}, and what parameter_dict/2 adds, for each
%   setting that Predicate of the mechanism Name takes.
%
%   @error existence_error(mechanism, Name)

mechanism_parameters(Name, Predicate, Dicts) :-
    mechanism_operator(Name, _),
    findall(Dict,
            ( parameter(Predicate, Parameter, About),
              parameter_dict(Parameter, Dict0),
              put_dict(about, Dict0, About, Dict) ),
            Dicts).

%   mechanism_file(+Name, -File) is semidet: File is its operator.

mechanism_file(Name, File) :-
    folder(Dir),
    operator_in(Dir, Name, File),
    !.

operator_in(Dir, Name, File) :-
    directory_files(Dir, Names),
    member(Name, Names),
    \+ sub_atom(Name, 0, _, _, '.'),
    directory_file_path(Dir, Name, Folder),
    directory_file_path(Folder, 'operator.pl', File),
    exists_file(File).

%!  mechanism_dicts(-Dicts) is det.
%
%   Dicts are _{name, predicates} for each mechanism, where predicates are
%   _{name, arguments, about}: arguments are pairs of `+` or `-` and a name,
%   `about` is the text of the comment.

mechanism_dicts(Dicts) :-
    findall(Name, ( folder(Dir), operator_in(Dir, Name, _) ), Names0),
    sort(Names0, Names),
    findall(_{name:Text, predicates:Predicates},
            ( member(Name, Names),
              mechanism_file(Name, File),
              predicates(File, Predicates),
              atom_string(Name, Text) ),
            Dicts).

predicates(File, Dicts) :-
    setup_call_cleanup(
        prolog_open_source(File, In),
        ( set_stream(In, encoding(utf8)),
          read_comments(In, Comments) ),
        prolog_close_source(In)),
    findall(Dict, ( member(Comment, Comments),
                    predicate_dict(Comment, Dict) ), Dicts).

read_comments(In, Comments) :-
    prolog_read_source_term(In, Term, _, [comments(Here)]),
    (   Term == end_of_file
    ->  Comments = []
    ;   findall(Text, member(_-Text, Here), Comments, Rest),
        read_comments(In, Rest)
    ).

%   Comment begins with heads like `%!  name(+A, -B) is det.`; several heads may
%   share the text below them, which is indented by four columns, those of `%   `.
%   Variables are bound to their names, as the page shows these.

predicate_dict(Comment, _{name:Name, arguments:Arguments, about:About}) :-
    string_concat("%!", _, Comment),
    split_string(Comment, "\n", "", Lines),
    partition(is_head, Lines, Heads0, Texts0),
    maplist(without_margin, Heads0, Heads),
    maplist(without_margin, Texts0, Texts),
    atomic_list_concat(Texts, '\n', Text),
    split_string(Text, "", " \n", [About]),
    atomic_list_concat(Heads, '\n', Modes),
    setup_call_cleanup(open_string(Modes, In), modes(In, All), close(In)),
    member(Mode, All),
    ( Mode = (Head is _) -> true ; Head = Mode ),
    compound(Head),
    compound_name_arguments(Head, Name0, Parameters),
    atom_string(Name0, Name),
    maplist(argument, Parameters, Arguments).

is_head(Line) :-
    string_concat("%!", _, Line).

without_margin(Line, Text) :-
    string_length(Line, Length),
    Margin is min(4, Length),
    sub_string(Line, Margin, _, 0, Text).

%   A comment of another form has no heads.

modes(In, Modes) :-
    catch(read_term(In, Mode, [variable_names(Names)]), error(_, _),
          Mode = end_of_file),
    (   Mode == end_of_file
    ->  Modes = []
    ;   maplist(call, Names),
        Modes = [Mode|Rest],
        modes(In, Rest)
    ).

argument(Parameter, [Sign, Name]) :-
    ( Parameter = Typed:_ -> true ; Typed = Parameter ),
    (   Typed =.. [Sign0, Name0]
    ->  true
    ;   Sign0 = (+),
        Name0 = Typed
    ),
    maplist(atom_string, [Sign0, Name0], [Sign, Name]).
