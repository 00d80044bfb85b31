:- module(typhon_page_mechanisms,
          [ mechanism_dicts/1,          % -Dicts
            mechanism_file/2,           % +Name, -File
            program_names/1             % -Names
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(prolog_source),
              [ prolog_close_source/1, prolog_open_source/2,
                prolog_read_source_term/4 ]).
:- use_module('../../kernel/program', []).        % where agents(Name) is found

/** <module> What there is in agents/

The operator of a mechanism is the module by which people use it.  What its
predicates take is read from their comments: no mechanism is known by name.

*Threading*: any thread; files are read anew each time.
*/

%!  program_names(-Names:list(string)) is det.
%
%   Agent programs that are found by agents(Name), as one writes them.

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
    atomic_list_concat(Parts, /, Base),
    path_term(Parts, Path),
    format(string(Name), 'agents(~q)', [Path]).

path_term([Part|Parts], Path) :-
    path_term(Parts, Part, Path).

path_term([], Path, Path).
path_term([Part|Parts], Path0, Path) :-
    path_term(Parts, Path0/Part, Path).

folder(Dir) :-
    absolute_file_name(agents(.), Dir,
                       [ file_type(directory), solutions(all),
                         file_errors(fail) ]).

%   The first term that is no comment tells.

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

%!  mechanism_file(+Name, -File) is semidet.

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
%   Each is _{name, predicates}, predicates being _{name, arguments, about}:
%   arguments are pairs of `+` or `-` and a name, `about` is the comment.

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

%   %!  name(+A, -B) is det.  Several heads may share what follows.

predicate_dict(Comment, _{name:Name, arguments:Arguments, about:About}) :-
    string_concat("%!", _, Comment),
    split_string(Comment, "\n", "", Lines0),
    maplist(uncommented, Lines0, Lines),
    heads_and_text(Lines, Heads, About),
    member(Head, Heads),
    head_parts(Head, Name, Arguments).

uncommented(Line0, Line) :-
    split_string(Line0, "", " ", [Line1]),
    (   string_concat("%!", Line, Line1)
    ->  true
    ;   string_concat("%", Line, Line1)
    ->  true
    ;   Line = Line1
    ).

heads_and_text(Lines, Heads, About) :-
    heads(Lines, Text0, "", All),
    maplist(without_margin, Text0, Text),
    atomic_list_concat(Text, '\n', About0),
    split_string(About0, "", " \n", [About]),
    split_string(All, ".", " ", Heads0),
    findall(Head, ( member(Head, Heads0), Head \== "" ), Heads).

without_margin(Line0, Line) :-
    (   string_concat("   ", Line, Line0)
    ->  true
    ;   Line = Line0
    ).

heads([Line|Lines], Text, All0, All) :-
    split_string(Line, "", " ", [Words]),
    Words \== "",
    !,
    atomic_list_concat([All0, ' ', Words], All1),
    heads(Lines, Text, All1, All).
heads(Text, Text, All, All).

%   A variable is called by its name.

head_parts(Text, Name, Arguments) :-
    catch(term_string(Term, Text, [variable_names(Bindings)]),
          error(_, _), fail),
    maplist(call, Bindings),
    without_determinism(Term, Head),
    compound(Head),
    compound_name_arguments(Head, Name0, Modes),
    atom_string(Name0, Name),
    maplist(argument, Modes, Arguments).

without_determinism((Head is _), Head) :- !.
without_determinism(Head, Head).

argument(Mode0, [Sign, Name]) :-
    ( Mode0 = Mode:_Type -> true ; Mode = Mode0 ),
    (   Mode =.. [Sign0, Name0]
    ->  true
    ;   Sign0 = (+),
        Name0 = Mode
    ),
    maplist(atom_string, [Sign0, Name0], [Sign, Name]).
