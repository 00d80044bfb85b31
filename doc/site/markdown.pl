:- module(site_markdown,
          [ site_markdown/5,            % +Path, +Public, +Played, +Text, -Markdown
            source_page/4,              % +Path, +Public, +Text, -Markdown
            link_target/2               % +Text, -Target
          ]).

/** <module> Markdown with programs in colours, and links to predicates

MkDocs does the rest. Paths are relative to the root of the tree; Public are
the predicates of the reference, atoms as `move/1`.

*Threading*: any thread.
*/

:- use_module(library(dcg/basics), [eos//0, string//1, string_without//2]).
:- use_module(library(lists), [member/2]).
:- use_module(colour, [code_html/4]).

%!  site_markdown(+Path, +Public, +Played:list(pair), +Text:string,
%!                -Markdown:string) is det.
%
%   The document at Path with programs in colours, links from predicates named
%   as code to the reference, and from files to their pages, and from sessions of
%   Played, Session-Id, to the playground.

site_markdown(Path, Public, Played, Text, Markdown) :-
    root(Path, Root),
    string_codes(Text, Codes),
    phrase(lines(page(site(Root, Public), Played), Parts), Codes),
    joined(Parts, Markdown).

%!  source_page(+Path, +Public, +Text:string, -Markdown:string) is det.
%
%   The page of a file that is no document.

source_page(Path, Public, Text, Markdown) :-
    root(Path, Root),
    file_name_extension(_, Extension, Path),
    code(Extension, Text, site(Root, Public), Code),
    joined(['---\nsearch: {exclude: true}\n---\n# ', Path, '\n\n', Code],
           Markdown).

code(pl, Text, Site, Html) :-
    !,
    code_html(prolog, Text, Site, Html).
code(Extension, Text, _, Fenced) :-
    joined(['````', Extension, '\n', Text, '````\n'], Fenced).

%!  link_target(+Text, -Target:atom) is nondet.
%
%   Text has a link to Target.

link_target(Text, Target) :-
    atomic_list_concat([_|Pieces], '](', Text),
    member(Piece, Pieces),
    once(sub_atom(Piece, Length, _, _, ')')),
    sub_atom(Piece, 0, Length, _, Target).

%   From the folder of Path to the root, as '../'.

root(Path, Root) :-
    atomic_list_concat([_|Folders], /, Path),
    findall('../', member(_, Folders), Ups),
    atomic_list_concat(Ups, Root).

joined(Parts, Text) :-
    atomic_list_concat(Parts, Atom),
    atom_string(Atom, Text).

                /*******************************
                *            TEXT              *
                *******************************/

%   Headings stay as they are: they are in tables of contents, too.

lines(Site, [Part|Parts]) -->
    fenced(Site, Part),
    !,
    lines(Site, Parts).
lines(Site, [Start, Line, '\n'|Parts]) -->
    verbatim(Start), text("\n", Line), "\n",
    !,
    lines(Site, Parts).
lines(Site, Parts) -->
    line(Site, Parts).

verbatim(#) --> "#".
verbatim('    ') --> "    ".

fenced(page(Site, Played), Part) -->
    "```", text("\n", Kind), "\n", string(Codes), "\n```\n",
    !,
    { string_codes(Code, Codes),
      string_concat(Code, "\n", Text),
      (   memberchk(Kind, ["prolog", "prolog-session"])
      ->  atom_string(Name, Kind),
          code_html(Name, Text, Site, Html),
          run_here(Text, Played, Site, Link),
          joined([Html, Link], Part)
      ;   joined(['```', Kind, '\n', Text, '```\n'], Part)
      ) }.

%   The playground is beside the pages; it needs a server.

run_here(Session, Played, site(Root, _), Link) :-
    memberchk(Session-Id, Played),
    !,
    joined(['\n<p class="run-here"><a href="', Root, 'play/index.html#doc=', Id,
            '">Run it here</a></p>\n\n'], Link).
run_here(_, _, _, '').

line(_, []) -->
    eos,
    !.
line(Site, ['\n'|Parts]) -->
    "\n",
    !,
    lines(Site, Parts).
line(Site, [Part|Parts]) -->
    part(Site, Part),
    !,
    line(Site, Parts).
line(Site, [Char|Parts]) -->
    [Code],
    { char_code(Char, Code) },
    line(Site, Parts).

part(_, Link) -->
    "[", text("[]", Text), "](", text(")", Target0), ")",
    { page(Target0, Target),
      joined(['[', Text, '](', Target, ')'], Link) }.
part(page(site(Root, Public), _), Part) -->
    "`", text("`", Code), "`",
    {   predicate_named(Code, PI),
        memberchk(PI, Public)
    ->  joined(['[`', Code, '`](', Root, 'predicates.md#', PI, ')'], Part)
    ;   joined(['`', Code, '`'], Part)
    }.

%   text(+End:string, -Text:string): up to one of the characters of End.

text(End, Text) -->
    { string_codes(End, Stop) },
    string_without(Stop, Codes),
    { string_codes(Text, Codes) }.

%   A file that is not of MkDocs has a page, see source_page/4.

page(Target, Target) :-
    (   sub_atom(Target, _, _, _, :)
    ;   sub_atom(Target, _, _, _, #)
    ;   file_name_extension(_, Extension, Target),
        memberchk(Extension, [md, png, svg])
    ),
    !.
page(Target, Page) :-
    string_concat(Target, ".md", Page).

%   As in `move/1` and `move(+Host)`.

predicate_named(Text, PI) :-
    catch(term_string(Term, Text), error(_, _), fail),
    nonvar(Term),
    (   Term = Name/Arity
    ->  atom(Name),
        integer(Arity)
    ;   compound(Term),
        compound_name_arity(Term, Name, Arity),
        forall(arg(_, Term, Arg), moded(Arg))
    ),
    atomic_list_concat([Name, Arity], /, PI).

moded(Arg) :-
    compound(Arg),
    compound_name_arguments(Arg, Mode, [_]),
    memberchk(Mode, [+, -, ?, :]).
