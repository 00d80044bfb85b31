:- module(site_layout,
          [ page_html/4                 % +Page, +Groups, +Version, -Html
          ]).

/** <module> What is round the text of a page

*Threading*: pure.
*/

:- use_module(library(lists), [append/3, member/2]).
:- use_module(dom, [dom_attribute/3, dom_html/2, dom_text/2]).

%!  page_html(+Page, +Groups, +Version, -Html:string) is det.
%
%   Page is page(File, Title, Dom); Groups are Heading-Pages, in the order
%   in which they are to be read.

page_html(page(File, Title, Dom), Groups, Version, Html) :-
    findall(Entry, group_entry(Groups, File, Entry), Entries),
    atomic_list_concat([Title, ' - Typhon'], Full),
    steps(Groups, File, Steps),
    dom_html([ element(html, [lang=en],
        [ element(head, [],
            [ element(meta, [charset='utf-8'], []),
              element(meta, [name=viewport,
                             content='width=device-width,initial-scale=1'],
                      []),
              element(meta, [name='color-scheme', content='light dark'], []),
              element(title, [], [Full]),
              element(link, [rel=stylesheet, href='style.css'], [])
            ]),
          element(body, [],
            [ element(nav, [],
                [ element(a, [class=name, href='index.html'], ["Typhon"]),
                  element(small, [], [" ", Version]),
                  element(input, [type=search, id=search,
                                  placeholder='Search ( / )',
                                  'aria-label'='Search'], []),
                  element(div, [id=found, role=status], []),
                  element(input, [type=checkbox, id=menu], []),
                  element(label, [for=menu], ["Contents"]),
                  element(div, [class=entries], Entries)
                ]),
              element(main, [], [element(article, [], Dom), Steps]),
              element(script, [src='sections.js'], []),
              element(script, [src='search.js'], [])
            ])
        ])
    ], Body),
    string_concat("<!DOCTYPE html>\n", Body, Html).

                /*******************************
                *          NAVIGATION          *
                *******************************/

group_entry(Groups, Here, Entry) :-
    member(Heading-Pages, Groups),
    (   Entry = element(h2, [], [Heading])
    ;   findall(Item, page_item(Pages, Here, Item), Items),
        Entry = element(ul, [], Items)
    ).

page_item(Pages, Here, element(li, [], [Link|Sections])) :-
    member(page(File, Title, Dom), Pages),
    (   File == Here
    ->  Link = element(a, ['aria-current'=page, href=File], [Title]),
        findall(Item, section_item(Dom, Item), Items),
        Sections = [element(ul, [], Items)]
    ;   Link = element(a, [href=File], [Title]),
        Sections = []
    ).

section_item(Dom, element(li, [], [element(a, [href=Link], [Text])])) :-
    member(Heading, Dom),
    Heading = element(h2, _, Title),
    dom_attribute(Heading, id, Id),
    atom_concat(#, Id, Link),
    dom_text(Title, Text).

%   What was to be read before, and what comes next.

steps(Groups, Here, element(footer, [], Steps)) :-
    findall(Page, ( member(_-Pages, Groups), member(Page, Pages) ), All),
    findall(Step, step(All, Here, Step), Steps).

step(All, Here, Step) :-
    append(_, [page(File, Title, _), page(Here, _, _)|_], All),
    step_link(prev, "\u2190 ", Title, "", File, Step).
step(All, Here, Step) :-
    append(_, [page(Here, _, _), page(File, Title, _)|_], All),
    step_link(next, "", Title, " \u2192", File, Step).

step_link(Rel, Before, Title, After, File,
          element(a, [rel=Rel, href=File], [Before, Title, After])).
