:- module(test_doc, []).

%   The code and the sessions in the documents are correct.
%
%   - A block ```prolog whose first line is `% name.pl` is a file. Agent
%     programs and payloads must be without problems. Other ```prolog blocks
%     must be clauses.

%   - A block ```text whose first line is `% name.pl` is a file, too, and may
%     be wrong; so is ```python with `# name.py`.

%   - A block ```prolog-session is typed at the top level in a terminal, one
%     for each document, in a directory that holds its files. Ports, marks of
%     agents, numbers of variables and long floats are not compared, nor are
%     the bindings of `$Var`. A line `...` stands for any lines.
%
%   Links between documents, and to files of the tree, resolve. Each document
%   is in one section of doc/contents.md. And every export of the library has a
%   PlDoc comment with modes.

:- use_module('../../app/packaging/parts', [installed/1, left_out/2]).
:- use_module('../lib/common').
:- use_module('../lib/redis', [redis_address/2, with_redis/2]).
:- use_module('../lib/texts', [write_file/2, file_lines/2]).
:- use_module('../lib/transcript', [transcript_differences/4]).
:- use_module('../lib/documents',
              [ block_file/2, block_text/2, block_write/2, blocks/2, document/1,
                outside/3, prose/2 ]).
:- use_module('../../doc/site/markdown', [link_target/2]).
:- use_module(library(apply), [exclude/3, maplist/2, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [append/3, member/2, nth0/3]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/program),
              [payload_load/2, program_load/6]).

                /*******************************
                *             FILES            *
                *******************************/

%   Must load, or at least be clauses.

check_block(Dir, Block) :-
    Block = block("prolog", _, Lines),
    !,
    (   block_file(Block, Name)
    ->  directory_file_path(Dir, Name, File),
        check_file(Lines, File)
    ;   block_text(Lines, Text),
        setup_call_cleanup(
            open_string(Text, In),
            read_all(In),
            close(In))
    ).
check_block(_, _).

check_file(Lines, File) :-
    member(Line, Lines),
    (   string_concat(":- agent(", _, Line)
    ->  program_load(File, _, _, _, _, _)
    ;   string_concat(":- payload(", _, Line)
    ->  payload_load(File, _)
    ),
    !.
check_file(_, File) :-
    setup_call_cleanup(open(File, read, In), read_all(In), close(In)).

read_all(In) :-
    read_term(In, Term, [syntax_errors(error)]),
    (   Term == end_of_file
    ->  true
    ;   read_all(In)
    ).

run_blocks(Blocks, Terminal, Differences, Dir) :-
    maplist(block_write(Dir), Blocks),
    maplist(check_block(Dir), Blocks),
    findall(Line-Lines,
            member(block("prolog-session", Line, Lines), Blocks),
            Sessions),
    transcript_differences(Sessions, Terminal, Dir, Differences).

                /*******************************
                *             LINKS            *
                *******************************/

broken_link(File, Link) :-
    prose(File, Text),
    link_target(Text, Link),
    \+ sub_atom(Link, _, _, _, '://'),
    \+ leads_somewhere(File, Link).

leads_somewhere(File, Link) :-
    atomic_list_concat([Path|_], #, Link),
    file_directory_name(File, Dir),
    absolute_file_name(Path, Target, [relative_to(Dir)]),
    project_file(Relative, Target),
    left_out(Relative, _),
    !.
leads_somewhere(File, Link) :-
    atomic_list_concat([Path|Place], #, Link),
    (   Path == ''
    ->  Target = File
    ;   file_directory_name(File, Dir),
        directory_file_path(Dir, Path, Target),
        exists_file(Target)
    ),
    (   Place = [Id]
    ->  heading(Target, Id)
    ;   true
    ),
    !.

heading(File, Id) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    outside(Text, "```", Parts),
    member(Part, Parts),
    split_string(Part, "\n", "", Lines),
    member(Line, Lines),
    string_concat("#", More, Line),
    split_string(More, "", "# ", [Heading]),
    slug(Heading, Id).

%   The anchor that GitHub makes of a heading: in lower case, blanks as
%   hyphens, without punctuation.

slug(Text, Slug) :-
    string_lower(Text, Lower),
    string_chars(Lower, Chars0),
    findall(Char, ( member(Char0, Chars0), slug_char(Char0, Char) ), Chars),
    atom_chars(Slug, Chars).

slug_char(' ', -).
slug_char(Char, Char) :-
    Char \== ' ',
    once(( char_type(Char, csym) ; Char == (-) )).

                /*******************************
                *           SECTIONS           *
                *******************************/

%   section(?Title, -Files): the documents that doc/contents.md lists below a
%   heading `## Title`.

section(Title, Files) :-
    project_file('doc/contents.md', Contents),
    read_file_to_string(Contents, Text, [encoding(utf8)]),
    atomic_list_concat([_|Sections], '\n## ', Text),
    member(Section, Sections),
    atomic_list_concat([Title|_], '\n', Section),
    file_directory_name(Contents, Dir),
    findall(File,
            ( link_target(Section, Link),
              directory_file_path(Dir, Link, Path),
              absolute_file_name(Path, File),
              exists_file(File) ),      % else it is of a part that is left out
            Files).

%   sections_of(-File, -Titles): of each document but README.md and the list.

sections_of(File, Titles) :-
    document(File),
    \+ ( member(Path, ['README.md', 'doc/contents.md']),
         project_file(Path, File) ),
    findall(Title, ( section(Title, Listed), member(File, Listed) ), Titles).

words(Files, Count) :-
    findall(Word,
            ( member(File, Files),
              read_file_to_string(File, Text, [encoding(utf8)]),
              words_of(Text, Words),
              member(Word, Words) ),
            All),
    length(All, Count).

words_of(Text, Words) :-
    split_string(Text, " \n\t", " \n\t", Words0),
    exclude(==(""), Words0, Words).

%   said_twice(+Files, -Said): Said are Row-Files: twelve words in a row,
%   outside code, that several of Files have. The lines of tables are no words.

said_twice(Files, Said) :-
    findall(Row-File,
            ( member(File, Files),
              prose(File, Prose),
              words_of(Prose, Words0),
              exclude(mark, Words0, Words),
              row_of_words(Words, Row) ),
            Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    findall(Row-Of, ( member(Row-Of, Groups), Of = [_,_|_] ), Said).

lists_changes(File) :-
    member(Name, ['CHANGELOG.md', 'UPGRADING.md']),
    project_file(Name, File).

mark(Word) :-
    \+ ( string_codes(Word, Codes), member(Code, Codes),
         code_type(Code, alnum) ).

row_of_words(Words, Row) :-
    length(List, 12),
    append(_, Rest, Words),
    append(List, _, Rest),
    atomic_list_concat(List, ' ', Row).

                /*******************************
                *            PLDOC             *
                *******************************/

library_file(File) :-
    project_file(prolog, Dir),
    directory_member(Dir, File, [extensions([pl]), recursive(true)]).

%   An interface, a file of directives alone, exports predicates that are
%   documented elsewhere.

undocumented(File, PI) :-
    library_file(File),
    exports(File, PIs),
    \+ ( catch(read_file_to_terms(File, Terms, []), error(_, _), fail),
         forall(member(Term, Terms), Term = (:- _)) ),
    file_lines(File, Lines),
    findall(Documented, documented(Lines, Documented), All),
    member(PI, PIs),
    \+ memberchk(PI, All).

exports(File, PIs) :-
    setup_call_cleanup(
        open(File, read, In),
        read(In, (:- module(_, PIs))),
        close(In)).

%   The head of a comment, with a mode for each argument.

documented(Lines, Name/Arity) :-
    append(_, [Line|More], Lines),
    string_concat("%!", Head0, Line),
    head(Head0, More, Head),
    functor(Head, Name, Arity),
    forall(( compound(Head), arg(_, Head, Arg) ), has_mode(Arg)).

head(Text0, _, Head) :-
    catch(term_string(Term, Text0,
                      [module(test_doc_modes), syntax_errors(quiet)]),
          error(syntax_error(_), _), fail),
    !,
    head_of(Term, Head).
head(Text0, [Line|Lines], Head) :-
    string_concat("%", More, Line),
    string_concat(Text0, More, Text),
    head(Text, Lines, Head).

head_of(is(Head, _), Head) :- !.
head_of(Head, Head).

has_mode(Arg0) :-
    nonvar(Arg0),
    (   Arg0 = (Arg:_Type)
    ->  true
    ;   Arg = Arg0
    ),
    functor(Arg, Mode, 1),
    memberchk(Mode, [+, -, ?, :, @, !, ++, --]).

:- op(200, fy, test_doc_modes:(:)).
:- op(200, fy, test_doc_modes:(?)).
:- op(200, fy, test_doc_modes:(@)).
:- op(200, fy, test_doc_modes:(!)).
:- op(200, fy, test_doc_modes:(++)).
:- op(200, fy, test_doc_modes:(--)).

broken_links_in(Text, Links, Dir) :-
    directory_file_path(Dir, 'doc.md', File),
    write_file(File, Text),
    findall(Link, broken_link(File, Link), Links).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(documentation).

%   The packages that documents need beside python3, and other suites do not.

needs('doc/journal.md', journal).
needs('doc/security.md', cells).
needs('doc/fleets.md', fleet).

needing(Group, File) :-
    needs(Document, Group),
    project_file(Document, File).

%   uses(?Document, ?Part): what its sessions show is of Part.

uses('doc/time.md', migration).
uses('doc/tutorial.md', migration).

shown_elsewhere(File) :-
    uses(Document, Part),
    project_file(Document, File),
    \+ installed(Part).

%   README.md is typed at the narrowest terminal and at the widest, every other
%   document at one of all.

document_at(File, terminal(Columns, Colour)) :-
    project_file('README.md', File),
    member(Columns-Colour, [60-true, 132-false]).
document_at(File, Terminal) :-
    findall(Document, other_document(Document), Documents),
    findall(One, terminal(One), Terminals),
    nth0(N, Documents, File),
    length(Terminals, Length),
    M is N mod Length,
    nth0(M, Terminals, Terminal).

other_document(File) :-
    document(File),
    \+ project_file('README.md', File),
    \+ needing(_, File),
    \+ shown_elsewhere(File).

terminal(terminal(Columns, Colour)) :-
    member(Columns, [60, 80, 132]),
    member(Colour, [true, false]).

differences(File, Terminal, Differences) :-
    blocks(File, Blocks),
    with_tmp_dir(run_blocks(Blocks, Terminal, Differences)).

%   The engine of documents is at port 6379.

differences_with_engine(File, Differences) :-
    blocks(File, Blocks0),
    with_redis(Redis,
               ( redis_address(Redis, _:Port),
                 maplist(at_port(Port), Blocks0, Blocks),
                 with_tmp_dir(run_blocks(Blocks, terminal(80, true),
                                         Differences)) )).

at_port(Port, block(Kind, N, Lines0), block(Kind, N, Lines)) :-
    block_text(Lines0, Text0),
    atomic_list_concat(Parts, '6379', Text0),
    atomic_list_concat(Parts, Port, Text),
    split_string(Text, "\n", "", Split),
    append(Lines, [""], Split).

%   What users search for is the subject of a section, see test_search, too.

asked_for(Word) :-
    member(Word, [ license, backup, upgrade, uninstall, windows, macos,
                   broadcast, contribute, bug ]).

%   The word is in a heading, or in the paragraphs below a heading that begins
%   with its first letters: `Back up a journal`.

about(Lines, Word) :-
    atom_length(Word, Length),
    Most is min(4, Length),
    sub_atom(Word, 0, Most, _, Stem),
    append(_, [Heading|Below], Lines),
    string_concat("#", Title, Heading),
    string_lower(Title, Lower),
    (   sub_string(Lower, _, _, _, Word)
    ->  true
    ;   sub_string(Lower, _, _, _, Stem)
    ;   memberchk(Word, [broadcast]),
        nth0(N, Below, Line),
        N < 4,
        sub_string(Line, _, _, _, Word)
    ),
    !.

test(each_word_that_users_look_for_has_a_section,
     [forall(asked_for(Word)), true(Files = [_|_])]) :-
    findall(File, ( document(File),
                    file_lines(File, Lines),
                    about(Lines, Word) ), Files).
test(sessions_answer_as_shown,
     [ condition(missing([python3], [])),
       forall(document_at(File, Terminal)),
       Differences == [] ]) :-
    differences(File, Terminal, Differences).
test(sessions_with_a_journal_answer_as_shown,
     [ condition(missing([python3, journal], [])), Differences == [], nondet ]) :-
    needing(journal, File),
    differences(File, terminal(80, true), Differences).
test(sessions_with_a_fleet_answer_as_shown,
     [ condition(missing([python3, fleet], [])), Differences == [], nondet ]) :-
    needing(fleet, File),
    differences_with_engine(File, Differences).
test(sessions_with_cells_answer_as_shown,
     [ condition(missing([python3, cells], [])), Differences == [], nondet ]) :-
    needing(cells, File),
    differences(File, terminal(80, true), Differences).

test(links_resolve, Broken == []) :-
    findall(Base:Link,
            ( document(File), broken_link(File, Link),
              file_base_name(File, Base) ),
            Broken).

test(sections_are_four,
     Titles == ['Platform', 'Thesis', 'Course', 'Development']) :-
    findall(Title, section(Title, _), Titles).
test(each_document_is_in_one_section, Others == []) :-
    findall(File-Titles,
            ( sections_of(File, Titles), Titles \= [_] ),
            Others).

test(platform_has_at_most_40_000_words, true(Count =< 40 000)) :-
    once(section('Platform', Files)),
    words(Files, Count).

test(twelve_words_are_in_one_document, Said == []) :-
    findall(File, ( sections_of(File, _), \+ lists_changes(File) ), Files),
    said_twice(Files, Said).
test(words_of_two_documents_are_found,
     Said == ['a b c d e f g h i j k l'-[First,Second]]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'a.md', First),
          directory_file_path(Dir, 'b.md', Second),
          write_file(First, "Then a b c d e\nf g h i j k l n"),
          write_file(Second, "a b c d e f g h i j k l m"),
          said_twice([First, Second], Said) )).

test(broken_links_are_found,
     Links == ['none.md', 'doc.md#none', '#none']) :-
    with_tmp_dir(broken_links_in(
        "# A heading, `code` & more\n[a](doc.md) [b](none.md)\n\c
         [c](doc.md#a-heading-code--more) [d](doc.md#none) [e](#none)\n\c
         `[f](no)`\n```\n[g](no)\n# none\n```\n",
        Links)).

test(every_export_has_a_comment_with_modes, Missing == []) :-
    findall(Base:PI,
            ( undocumented(File, PI), file_base_name(File, Base) ),
            Missing).

% In architecture.md a code span `file.pl` or `file.pl:name/arity` that begins
% with the name of a folder is a file below prolog/typhon, and a predicate that
% is defined there.

test(architecture_names_existing_files_and_predicates,
     Missing == []) :-
    project_file('doc/architecture.md', Document),
    read_file_to_string(Document, Text, [encoding(utf8)]),
    split_string(Text, "`", "", Spans),
    findall(Span, ( member(Span, Spans), source_reference(Span, _, _) ), Found),
    Found = [_,_,_,_,_|_],
    findall(Span, ( member(Span, Found), \+ reference_holds(Span) ), Missing).

source_reference(Span, Path, PI) :-
    split_string(Span, ":", "", [Path|PIs]),
    file_name_extension(_, pl, Path),
    string_concat("kernel/", _, Path),
    (   PIs = [Text]
    ->  split_string(Text, "/", "", [Name0,Arity0]),
        atom_string(Name, Name0),
        number_string(Arity, Arity0),
        PI = Name/Arity
    ;   PIs == [],
        PI = none
    ).

reference_holds(Span) :-
    source_reference(Span, Path, PI),
    format(atom(Relative), 'prolog/typhon/~w', [Path]),
    project_file(Relative, File),
    exists_file(File),
    (   PI = Name/Arity
    ->  load_files(File, [if(not_loaded), imports([])]),
        module_property(Module, file(File)),
        functor(Head, Name, Arity),
        predicate_property(Module:Head, defined),
        \+ predicate_property(Module:Head, imported_from(_))
    ;   true
    ).

:- end_tests(documentation).
