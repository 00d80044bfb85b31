:- module(test_pictures, []).
:- use_module('../lib/common').
:- use_module('../lib/documents', [document/1]).

:- needs([page]).

% doc/pictures.pl makes the pictures of the page that documents show.

:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3]).

png_size(File, Width*Height) :-
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        read_string(In, 24, Text),
        close(In)),
    string_codes(Text, Codes),
    append(_, [W1, W0, 0, 0, H1, H0], Codes),
    !,
    Width is W1*256 + W0,
    Height is H1*256 + H0.

%   page-NAME.png as documents name them.

shown(Names) :-
    findall(Name,
            ( document(Document),
              read_file_to_string(Document, Text, [encoding(utf8)]),
              sub_string(Text, At, _, _, "img/page-"),
              Start is At + 4,
              sub_string(Text, Start, _, 0, Rest),
              once(sub_string(Rest, Length, _, _, ")")),
              sub_atom(Rest, 0, Length, _, Name) ),
            Names0),
    sort(Names0, Names).

:- begin_tests(pictures).

%   The script itself fails if the page shows anything outside its network.

test(script_makes_the_shown_pictures, Names-Sizes == Shown-[1600*1000]) :-
    shown(Shown),
    with_tmp_dir(Dir,
        ( project_file('doc/pictures.pl', Script),
          run_swipl([Script, '--', Dir, page], [timeout(120)], exit(0), _, _),
          directory_files(Dir, Entries),
          findall(Name-Size,
                  ( member(Name, Entries),
                    file_name_extension(_, png, Name),
                    directory_file_path(Dir, Name, File),
                    png_size(File, Size) ),
                  Pairs0),
          sort(Pairs0, Pairs),
          findall(Name, member(Name-_, Pairs), Names),
          findall(Size, member(_-Size, Pairs), Sizes0),
          sort(Sizes0, Sizes) )).

:- end_tests(pictures).
