:- module(site_markdown,
          [ markdown_dom/2,             % +File, -Dom
            slug/2                      % +Text, -Slug
          ]).

/** <module> Markdown, read as GitHub reads it

By cmark-gfm, GitHub's own reader. It leaves to others what to call the
headings; here they are called as GitHub does.

*Threading*: any thread.
*/

:- use_module(library(apply), [foldl/6]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(dom, [dom_text/2, html_dom/2]).

%!  markdown_dom(+File, -Dom) is det.
%
%   Dom is the text of File, its headings with ids.
%
%   @error what process_create/3 throws where there is no cmark-gfm

markdown_dom(File, Dom) :-
    setup_call_cleanup(
        process_create(path('cmark-gfm'),
                       ['-e', table, '-e', autolink, file(File)],
                       [stdout(pipe(Out, [encoding(utf8)])), process(Pid)]),
        read_string(Out, _, Html),
        close(Out)),
    process_wait(Pid, exit(0)),
    html_dom(Html, Dom0),
    foldl(name_heading, Dom0, Dom, [], _).

name_heading(element(Name, [], Text), element(Name, [id=Id], Text),
             Used, [Slug|Used]) :-
    heading(Name),
    !,
    dom_text(Text, String),
    slug(String, Slug),
    findall(x, member(Slug, Used), Before),
    length(Before, N),
    numbered(N, Slug, Id).
name_heading(Node, Node, Used, Used).

heading(h1).
heading(h2).
heading(h3).
heading(h4).

numbered(0, Slug, Slug) :-
    !.
numbered(N, Slug, Id) :-
    atomic_list_concat([Slug, N], -, Id).

%!  slug(+Text, -Slug:atom) is det.
%
%   By what name GitHub knows a heading: in lower case, blanks as hyphens,
%   without punctuation.

slug(Text, Slug) :-
    string_lower(Text, Lower),
    string_chars(Lower, Chars0),
    findall(Char, ( member(Char0, Chars0), slug_char(Char0, Char) ), Chars),
    atom_chars(Slug, Chars).

slug_char(' ', -) :-
    !.
slug_char(Char, Char) :-
    (   char_type(Char, csym)
    ;   Char == (-)
    ),
    !.
