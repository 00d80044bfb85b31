:- module(typhon_page_guard,
          [ token_new/1,                % -Token
            token_right/2,              % +Given, +Token
            request_own/1,              % +Request
            request_within/2,           % +Request, +Bytes
            guarding_headers/0,
            page_file/3                 % +Names, -File, -Type
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [memberchk/2, same_length/2]).
:- use_module(library(option), [option/2]).
:- use_module('../../kernel/wire', [random_hex/2]).

/** <module> Access to a page, and headers that restrict its browser

The token gives access.  It is the first part of each path, so scripts and
styles of the page, whose addresses are relative, are protected as well, and no
cookie is sent to other servers of the machine.  Requests that another site
makes a browser send are refused by their origin.

*Threading*: any thread.
*/

%!  token_new(-Token:atom) is det.
%
%   Token is a random text that cannot be guessed.

token_new(Token) :-
    random_hex(16, Token).

%!  token_right(+Given, +Token) is semidet.
%
%   Given equals Token.  The comparison takes the same time however many
%   characters agree, so that a client cannot find the token by measuring it.

token_right(Given, Token) :-
    atom_codes(Given, A),
    atom_codes(Token, B),
    same_length(A, B),
    differences(A, B, 0, 0).

differences([], [], Sum, Sum).
differences([A|As], [B|Bs], Sum0, Sum) :-
    Sum1 is Sum0 \/ (A xor B),
    differences(As, Bs, Sum1, Sum).

%!  request_own(+Request) is semidet.
%
%   Request has no origin, or this server is its origin: so no page of another
%   site has made a browser send it.

request_own(Request) :-
    (   option(origin(Origin), Request)
    ->  memberchk(host(Host), Request),
        authority(Host, Request, Authority),
        atom_concat('http://', Authority, Origin)
    ;   true
    ).

authority(Host, Request, Authority) :-
    (   option(port(Port), Request),
        Port \== 80
    ->  format(atom(Authority), '~w:~w', [Host, Port])
    ;   Authority = Host
    ).

%!  request_within(+Request, +Bytes) is semidet.
%
%   The body of Request has a known length, of at most Bytes.

request_within(Request, Bytes) :-
    memberchk(content_length(Length), Request),
    integer(Length),
    Length =< Bytes.

%!  guarding_headers is det.
%
%   Print headers.  With these a browser loads nothing from elsewhere, runs only
%   our files as scripts, shows the page in no frame of another site, and sends
%   its address, which contains the token, to no other site.

guarding_headers :-
    forall(header(Name, Value), format('~w: ~w\r\n', [Name, Value])).

header('Content-Security-Policy', Policy) :-
    findall(Part, policy(Part), Parts),
    atomic_list_concat(Parts, '; ', Policy).
header('X-Content-Type-Options', nosniff).
header('X-Frame-Options', 'DENY').
header('Referrer-Policy', 'no-referrer').
header('Cross-Origin-Opener-Policy', 'same-origin').
header('Cross-Origin-Resource-Policy', 'same-origin').
header('Cache-Control', 'no-store').

%   Otherwise connections would wait for further requests, and be dropped when
%   the server stops.

header('Connection', close).

policy('default-src \'none\'').
policy('script-src \'self\'').
policy('style-src \'self\'').
policy('img-src \'self\' data: blob:').
policy('connect-src \'self\'').
policy('base-uri \'none\'').
policy('form-action \'none\'').
policy('frame-ancestors \'none\'').
policy('require-trusted-types-for \'script\'').
policy('trusted-types \'none\'').

                /*******************************
                *            FILES             *
                *******************************/

:- dynamic folder/1.

:- module_property(typhon_page_guard, file(Source)),
   file_directory_name(Source, Dir),
   directory_file_path(Dir, www, Www),
   retractall(folder(_)),
   assertz(folder(Www)).

%!  page_file(+Names:list(atom), -File, -Type) is semidet.
%
%   File is the file of the page that an address with Names after the token
%   denotes; Type is its media type.  No name leads out of the folder, hidden
%   files are not served, and a name with a zero, at which the operating system
%   would end the name, is refused.

page_file([''], File, Type) :-
    !,
    page_file(['index.html'], File, Type).
page_file([Name], File, Type) :-
    plain(Name),
    file_name_extension(_, Extension, Name),
    type(Extension, Type),
    folder(Folder),
    directory_file_path(Folder, Name, File),
    exists_file(File).

plain(Name) :-
    \+ sub_atom(Name, 0, _, _, '.'),
    \+ sub_atom(Name, _, _, _, /),
    \+ sub_atom(Name, _, _, _, \),
    \+ sub_atom(Name, _, _, _, '\x00\').

type(html, 'text/html; charset=UTF-8').
type(js, 'text/javascript; charset=UTF-8').
type(css, 'text/css; charset=UTF-8').
type(svg, 'image/svg+xml').
