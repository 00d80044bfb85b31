:- module(typhon_playground_session,
          [ session_begin/2             % +Message, -Kind
          ]).
:- use_module('../../experiments/engine/live', []).
:- use_module('../../experiments/engine/studies', [study_at_work/1, study_load/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(filesex),
              [ delete_directory_contents/1, directory_file_path/3,
                make_directory_path/1 ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../prolog/typhon/kernel/base/error_text', [print_error/2]).
:- use_module('../../prolog/typhon/network', [network_property/2, network_stop/1]).
:- use_module('../../prolog/typhon/kernel/host', [host/3, host_stop/1]).
:- use_module('../../prolog/typhon/tools/page/editor', [text_in/3]).
:- use_module('../../prolog/typhon/tools/page/models', [models_start/1, models_stop/0]).
:- use_module('../../prolog/typhon/tools/page/overlays', [overlays_start/1, overlays_stop/0]).
:- use_module('../../prolog/typhon/tools/page/slices', [slices_begin/1, slices_end/0]).

/** <module> Files and queries that a reader plays

Queries are those of a document: `?- Goal.`, one after the other, where `$Name`
is the value that Name has had before.  They run beside the page, see slices.pl,
and print their answers.

*Threading*: one thread.
*/

:- dynamic
    value/2.                    % Name, Value

%!  session_begin(+Message:dict, -Kind) is det.
%
%   End all that there is, and write the files in the field `files` of Message,
%   names with their texts.  Run the field `queries`, or make the file of the field
%   `study`, which is in the field `folder`, the model of the page: Kind is "session" or "model".  Virtual time runs
%   only when the page lets it.
%
%   @error page_syntax(queries, Error, Where), study(File, Problems)

session_begin(Message, Kind) :-
    get_dict(files, Message, Files),
    must_be(dict, Files),
    clear,
    in_folder(Message),
    forall(get_dict(Name, Files, Content), save(Name, Content)),
    begin(Message, Kind).

begin(Message, "model") :-
    get_dict(study, Message, Text),
    !,
    atom_string(File, Text),
    study_load(File, Study),
    study_at_work(Study),
    overlays_start([Study]),
    models_start([model(study_live:live(Study))]).
begin(Message, "session") :-
    text_in(queries, Message, Text),
    queries(Text, Queries),
    overlays_start([]),
    slices_begin(run_queries(Queries)).

clear :-
    models_stop,
    overlays_stop,
    slices_end,
    retractall(value(_, _)),
    forall(network_property(Network, seed(_)), network_stop(Network)),
    forall(host(Host, _, _), host_stop(Host)).

%   Programs are found in the working directory, which has no other files; but the
%   field `folder`, with the files of a study, has.

in_folder(Message) :-
    get_dict(folder, Message, Folder),
    !,
    working_directory(_, Folder).
in_folder(_) :-
    make_directory_path('/program'),
    delete_directory_contents('/program'),
    working_directory(_, '/program').

save(Name, Content) :-
    must_be(string, Content),
    below(Name, File),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        write(Out, Content),
        close(Out)).

%   Programs may be in a folder, as agents/walker.pl.

below(Name, File) :-
    atomic_list_concat(Parts, /, Name),
    (   Parts = [Folder, File0],
        \+ sub_atom(Folder, 0, _, _, '.')
    ->  make_directory_path(Folder),
        directory_file_path(Folder, File0, File)
    ;   file_base_name(Name, File)
    ).

queries(Text, Queries) :-
    setup_call_cleanup(
        open_string(Text, In),
        read_queries(In, Queries),
        close(In)).

read_queries(In, Queries) :-
    catch(read_term(In, Term, [variable_names(Names), module(user)]),
          error(syntax_error(Error), Where),
          throw(error(page_syntax(queries, syntax_error(Error), Where), _))),
    (   Term == end_of_file
    ->  Queries = []
    ;   ( Term = (?- Goal) -> true ; Goal = Term ),
        Queries = [query(Goal, Names)|Rest],
        read_queries(In, Rest)
    ).

%   Not forall/2: from a predicate in C a wait cannot leave the engine.

run_queries([]).
run_queries([query(Goal, Names)|Queries]) :-
    (   run_query(Goal, Names)
    ->  run_queries(Queries)
    ;   true
    ).

%   The queries after one that raises an error do not run.

run_query(Goal0, Names) :-
    with_values(Goal0, Names, Goal),
    format('?- ~@.~n', [written(Goal0, Names)]),
    (   catch(user:Goal, error(Formal, Context),
              ( print_error(error, error(Formal, Context)), fail ))
    ->  answered(Names)
    ;   format('false.~n')
    ).

with_values($(Var), Names, Value) :-
    var(Var),
    member(Name=Known, Names),
    Known == Var,
    value(Name, Value),
    !.
with_values(Term, Names, Result) :-
    compound(Term),
    !,
    compound_name_arguments(Term, Name, Args0),
    with_all(Args0, Names, Args),
    compound_name_arguments(Result, Name, Args).
with_values(Term, _, Term).

with_all([], _, []).
with_all([Arg0|Args0], Names, [Arg|Args]) :-
    with_values(Arg0, Names, Arg),
    with_all(Args0, Names, Args).

answered(Names) :-
    findall(Name=Value, ( member(Name=Value, Names), nonvar(Value) ), Pairs),
    forall(member(Name=Value, Pairs),
           ( retractall(value(Name, _)),
             assertz(value(Name, Value)),
             format('~w = ~q,~n', [Name, Value]) )),
    format('true.~n').

written(Goal, Names) :-
    \+ \+ ( bind_names(Names),
            write_term(Goal, [ quoted(true), numbervars(true), spacing(next_argument) ]) ).

bind_names([]).
bind_names([Name='$VAR'(Name)|Names]) :-
    bind_names(Names).
