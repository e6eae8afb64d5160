(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The kernel itself checks one real certificate of each kind, as the program wrote it, and refutes a forged one: no
   extraction, no OCaml, no reader. From each that holds follows what Theorems.v says of it. *)
Require Import Reals QArith Qreals List.
From ExactVO Require Import Theorems Checker.
Import ListNotations Checked.
Local Open Scope Q_scope.

Definition d (m : Z) (k : N) : Q := m # match (2 ^ k)%N with Npos p => p | N0 => 1 end.   (* a double: m / 2^k *)

(* --- A half-plane: a disc of radius 1 m at (4, 0), a robot of 0.5 m at (0, 0), 2 s --- *)
Definition past_a_disc : half_plane :=
  {| body := Disc (d 4 0, d 0 0) (d 1 0); body_velocity := (d 0 0, d 0 0);
     position := (d 0 0, d 0 0); radius := d 1 1; horizon := Some (d 2 0);
     normal := (d (-1) 0, d 0 0);
     offset := d (-1407374883553273) 50; margin := d 7 49 |}.
Definition past_a_disc_safely : keeps_clear past_a_disc.
Proof. apply half_plane_sound. vm_compute. reflexivity. Qed.
(* Its offset 64 ulps less: the margin that is stated is not there any more. *)
Example forged_half_plane : half_plane_holds
  {| body := Disc (d 4 0, d 0 0) (d 1 0); body_velocity := (d 0 0, d 0 0);
     position := (d 0 0, d 0 0); radius := d 1 1; horizon := Some (d 2 0);
     normal := (d (-1) 0, d 0 0);
     offset := d (-1407374883553289) 50; margin := d 7 49 |} = false.
Proof. vm_compute. reflexivity. Qed.

(* --- Two robots of a run whose half-planes are opposite --- *)
Definition against_the_other (its_offset : Q) : half_plane :=
  {| body := Polygon []; body_velocity := (d 0 0, d 0 0); position := (d 24 0, d 14 0); radius := d 1 1; horizon := Some (d 2 0);
     normal := (d 6156295726294935 54, d 8464906623655535 53); offset := its_offset; margin := 0 |}.
Definition other_place : point := (d 20 0, d 3 0).
Definition each_clear_of_the_other : keep_each_other_clear (against_the_other (d (-6003692317991841) 51)) other_place (d 1 1) (d (-6003692317991841) 51).
Proof. apply pair_sound. vm_compute. reflexivity. Qed.
Example one_gives_too_little : pair_holds (against_the_other (d (-6285167294702497) 51)) other_place (d 1 1) (d (-6003692317991841) 51) = false.
Proof. vm_compute. reflexivity. Qed.

(* --- A half-plane past the smallest ellipse round a box, and that it holds the box --- *)
Definition past_an_ellipse : half_plane :=
  {| body := Ellipse (d 3 0, d 0 0) (d 3184525836262909 51) (d (-140737488355329) 99) (d 3184525836262909 51); body_velocity := (d 0 0, d 0 0);
     position := (d 0 0, d 0 0); radius := d 1 1; horizon := Some (d 2 0);
     normal := (d (-4181487279093045) 52, d 6690379646548869 54);
     offset := d (-7847220702136055) 54; margin := d 5882841641760757 99 |}.
Definition past_an_ellipse_safely : keeps_clear past_an_ellipse.
Proof. apply half_plane_sound. vm_compute. reflexivity. Qed.
Definition round_the_box : shape := Ellipse (d 3 0, d 0 0) (d 3184525836262909 51) (d (-140737488355329) 99)
  (d 3184525836262909 51).
Example the_ellipse_holds_the_box : contains round_the_box [(d 2 0, d (-1) 0); (d 4 0, d (-1) 0); (d 4 0, d 1 0); (d 2 0, d 1 0)] (d 8943616651585361 99) = true.
Proof. vm_compute. reflexivity. Qed.
Example a_corner_moved_outward : contains round_the_box [(d 8962163258467287 52, d (-1) 0); (d 4 0, d (-1) 0); (d 4 0, d 1 0); (d 2 0, d 1 0)] 0 = false.
Proof. vm_compute. reflexivity. Qed.

(* --- Bodies that stand for an obstacle: two convex pieces of an L, and a wall in a disc --- *)
Definition corner_of_walls : obstacle := Solid [[(d 0 0, d 0 0); (d 4 0, d 0 0); (d 4 0, d 1 0); (d 1 0, d 1 0); (d 1 0, d 4 0); (d 0 0, d 4 0)]].
Definition lying : shape := Polygon [(d 0 0, d 0 0); (d 4 0, d 0 0); (d 4 0, d 1 0); (d 0 0, d 1 0)].
Definition standing (top : Q) : shape := Polygon [(d 0 0, d 0 0); (d 1 0, d 0 0); (d 1 0, top); (d 0 0, top)].
Example the_pieces_hold_it : hold [lying; standing (d 4 0)] corner_of_walls = true.
Proof. vm_compute. reflexivity. Qed.
Example a_piece_is_too_short : hold [lying; standing (d 17592186044415 42)] corner_of_walls = false.
Proof. vm_compute. reflexivity. Qed.
Example the_disc_holds_the_wall : hold [Disc (d 0 0, d 0 0) (d 5 0)] (Wall [(d 3 0, d 4 0); (d (-5) 0, d 0 0)]) = true.
Proof. vm_compute. reflexivity. Qed.
Example no_disc_is_below_0 : hold [Disc (d 0 0, d 0 0) (d (-5) 0)] (Wall [(d 3 0, d 4 0); (d (-5) 0, d 0 0)]) = false.
Proof. vm_compute. reflexivity. Qed.
Example a_disc_too_small : hold [Disc (d 0 0, d 0 0) (d 5497558138879 40)] (Wall [(d 3 0, d 4 0); (d (-5) 0, d 0 0)]) = false.
Proof. vm_compute. reflexivity. Qed.

(* --- A choice: the velocity nearest the preferred one --- *)
Definition program_nearest : program :=
  {| rows := [{| row_normal := (d (-1) 0, d 0 0); row_offset := d (-7) 2; soft := false |}];
     disc := Some (d 3 0); box_x := None; box_y := None; wish := (d 3 0, d 0 0) |}.
Definition choice_nearest : choice :=
  {| velocity := (d 985162418487293 49, d 0 0); gap := d 263882790666255 94; violation := d 0 0;
     pull := [d 703687441776643 49]; mu := d 0 0; against := [d 0 0] |}.
Definition proven_nearest : is_nearest program_nearest choice_nearest.
Proof. apply nearest_sound. vm_compute. reflexivity. Qed.
Example another_velocity_nearest : nearest program_nearest
  {| velocity := (d 914793674309629 49, d (-1) 2); gap := d 263882790666255 94; violation := d 0 0;
     pull := [d 703687441776643 49]; mu := d 0 0; against := [d 0 0] |} = false.
Proof. vm_compute. reflexivity. Qed.

(* --- A choice: two half-planes that contradict each other, broken least --- *)
Definition program_least : program :=
  {| rows := [{| row_normal := (d 1 0, d 0 0); row_offset := d 1 0; soft := true |};
     {| row_normal := (d (-1) 0, d 0 0); row_offset := d 1 0; soft := true |}];
     disc := Some (d 2 0); box_x := None; box_y := None; wish := (d 1 0, d 0 0) |}.
Definition choice_least : choice :=
  {| velocity := (d 1 49, d 0 0); gap := d 703687441776657 98; violation := d 562949953421313 49;
     pull := [d 1 0; d 1 0]; mu := d 0 0; against := [d 1 0; d 1 0] |}.
Definition proven_least : gives_least program_least choice_least.
Proof. apply least_sound. vm_compute. reflexivity. Qed.
Example another_velocity_least : least program_least
  {| velocity := (d (-70368744177663) 49, d (-1) 2); gap := d 703687441776657 98; violation := d 562949953421313 49;
     pull := [d 1 0; d 1 0]; mu := d 0 0; against := [d 1 0; d 1 0] |} = false.
Proof. vm_compute. reflexivity. Qed.

(* --- A choice: the farthest along a direction --- *)
Definition program_farthest : program :=
  {| rows := [{| row_normal := (d 0 0, d (-1) 0); row_offset := d (-1) 1; soft := false |}];
     disc := Some (d 2 0); box_x := None; box_y := None; wish := (d 0 0, d 1 0) |}.
Definition choice_farthest : choice :=
  {| velocity := (d 0 0, d 140737488355327 48); gap := d 2251799813685289 99; violation := d 0 0;
     pull := [d 1 0]; mu := d 0 0; against := [d 0 0] |}.
Definition proven_farthest : is_farthest program_farthest choice_farthest.
Proof. apply farthest_sound. vm_compute. reflexivity. Qed.
Example another_velocity_farthest : farthest program_farthest
  {| velocity := (d (-1) 3, d 70368744177663 48); gap := d 2251799813685289 99; violation := d 0 0;
     pull := [d 1 0]; mu := d 0 0; against := [d 0 0] |} = false.
Proof. vm_compute. reflexivity. Qed.

(* --- A region without interior: a point of it --- *)
Definition needle : program := {| disc := Some (d 2 0); box_x := None; box_y := None; wish := (d 1 0, d 0 0);
  rows := [{| row_normal := (d 1 0, d 0 0); row_offset := d 1 1; soft := false |};
           {| row_normal := (d (-1) 0, d 0 0); row_offset := d (-1) 1; soft := true |}] |}.
Definition one_is_left : allowed 0 needle (real (d 1 1, d 0 0)).
Proof. apply pinned_sound. vm_compute. reflexivity. Qed.
Example an_ulp_beside_it : pinned needle (d 4503599627370497 53, d 0 0) = false.
Proof. vm_compute. reflexivity. Qed.
Example no_speed_bound_is_below_0 : pinned {| disc := Some (d (-2) 0); box_x := None; box_y := None; wish := wish needle; rows := rows needle |}
  (d 1 1, d 0 0) = false.
Proof. vm_compute. reflexivity. Qed.
Definition none_is_allowed : forall w, ~ allowed 0 program_least w.
Proof. apply (contradicted_sound _ choice_least). vm_compute. reflexivity. Qed.
Example but_of_the_other_one : contradicted program_nearest choice_nearest = false.
Proof. vm_compute. reflexivity. Qed.

(* --- Routes and chains: a box with a door of 1.2 m --- *)
Definition box : list obstacle := [Wall [(d 3152519739159347 51, d 4 0); (d 0 0, d 4 0); (d 0 0, d 0 0); (d 4 0, d 0 0); (d 4 0, d 4 0); (d 5854679515581645 51, d 4 0)]].
Definition within : point := (2, 2).
Definition beyond : point := (2, 9).
Definition a_disc_of_half_a_metre_passes : forall e x, In e (sides [within; beyond]) -> on e x -> room box (Q2R (1 # 2)) x.
Proof. apply route_sound. vm_compute. reflexivity. Qed.
Example a_wider_one_does_not : route box (13 # 20) [within; beyond] = false.
Proof. vm_compute. reflexivity. Qed.
Definition door : list joint :=
  [{| spot := (d 3152519739159347 51, d 4 0); obstacle_no := 0; edge_no := 0; gap_follows := false |};
   {| spot := (d 0 0, d 4 0); obstacle_no := 0; edge_no := 1; gap_follows := false |};
   {| spot := (d 0 0, d 0 0); obstacle_no := 0; edge_no := 2; gap_follows := false |};
   {| spot := (d 4 0, d 0 0); obstacle_no := 0; edge_no := 3; gap_follows := false |};
   {| spot := (d 4 0, d 4 0); obstacle_no := 0; edge_no := 4; gap_follows := false |};
   {| spot := (d 5854679515581645 51, d 4 0); obstacle_no := 0; edge_no := 4; gap_follows := true |}].
Definition no_way : ~ way box (Q2R (13 # 20)) (real within) (real beyond).
Proof. apply (chain_sound _ _ _ _ door). vm_compute. reflexivity. Qed.
Example a_narrower_one_is_not_held : chain box (3 # 5) within beyond door = false.
Proof. vm_compute. reflexivity. Qed.
Definition no_room : ~ room box (Q2R (13 # 20)) (real (7 # 2, 2)).
Proof. apply (blocked_sound _ _ _ 0%nat (Some 3%nat)). vm_compute. reflexivity. Qed.
Example half_a_metre_has_room : blocked box (1 # 2) (7 # 2, 2) 0%nat (Some 3%nat) = false.
Proof. vm_compute. reflexivity. Qed.
Example no_radius_is_below_0 : blocked box (-1) (7 # 2, 2) 0%nat (Some 3%nat) = false.
Proof. vm_compute. reflexivity. Qed.

(* --- A run: the first rows of two robots in a room, past an edge of it --- *)
Definition edge_of_the_room : list obstacle := [Wall [(d 4 0, d 1351079888211149 50); (d 5854679515581645 50, d 1351079888211149 50)]].
Definition sizes : list Q := [d 5404319552844595 55; d 5404319552844595 55].
Definition first_rows : list (list point) :=
  [[(d 3152519739159347 52, d 5854679515581645 52); (d 5967269506265907 50, d 2 0)];
   [(d 3287401707159321 52, d 5795027405883229 52); (d 5934531597776325 50, d 8977300771548525 52)];
   [(d 3427300325464883 52, d 714317889352501 49); (d 5898432158740415 50, d 4491062039922825 51)];
   [(d 1789076048998239 51, d 5627875860636307 52); (d 183147997495149 45, d 4511925497897165 51)]].
Definition they_keep_apart : all_steps (fun a b => keeps_apart edge_of_the_room [] (moves sizes a b)) (with_start first_rows).
Proof. apply run_sound. vm_compute. reflexivity. Qed.
Example they_cannot_change_places : run edge_of_the_room [] sizes
  [[(d 3152519739159347 52, d 5854679515581645 52); (d 5967269506265907 50, d 2 0)];
   [(d 5967269506265907 50, d 2 0); (d 3152519739159347 52, d 5854679515581645 52)]] = false.
Proof. vm_compute. reflexivity. Qed.

(* Clear of all edges, and yet not where a robot may be: inside a polygon. *)
Example inside_is_refuted : run [Solid [[(-2, -2); (9, -2); (9, 9); (-2, 9)]]] [] sizes first_rows = false.
Proof. vm_compute. reflexivity. Qed.

(* One row that is not right; a disc that the first robot passes at exactly its distance, and one that is in its way. *)
Example one_row_is_judged : run edge_of_the_room [] [1; 1] [[(0, 9); (1, 9)]] = false.
Proof. vm_compute. reflexivity. Qed.
Definition post (r : Q) : list motion := [{| from := (1, 2); to := (1, 2); size := r |}].
Definition it_passes_the_post : all_steps (fun a b => keeps_apart [] (post 1) (moves [1] a b)) (with_start [[(-(5), 0)]; [(7, 0)]]).
Proof. apply run_sound. vm_compute. reflexivity. Qed.
Example a_larger_post_is_in_its_way : run [] (post (1025 # 1024)) [1] [[(-(5), 0)]; [(7, 0)]] = false.
Proof. vm_compute. reflexivity. Qed.

(* --- Braking: two robots drive at each other at 1 m/s, and can stop within 2 m each; 1/16 m farther on they cannot --- *)
Definition head_on (x speed : Q) : list driver :=
  [{| now_at := (x, 0); had := (speed, 0); chosen := (speed, 0); its_radius := 1 # 2; its_most := 1 # 2 |};
   {| now_at := (-x, 0); had := (-speed, 0); chosen := (-speed, 0); its_radius := 1 # 2; its_most := 1 # 2 |}].
Definition they_stop_in_time : can_brake [] [] (1 # 16) 2 (head_on (-(5 # 2)) 1).
Proof. apply brakes_sound; [vm_compute; reflexivity|]. intros d _ o []. Qed.
Example too_near_to_stop : brakes [] [] (1 # 16) 2 (head_on (-(39 # 16)) 1) = false.
Proof. vm_compute. reflexivity. Qed.
Example too_fast_to_stop : brakes [] [] (1 # 16) 2 (head_on (-9) (17 # 16)) = false.
Proof. vm_compute. reflexivity. Qed.
Example a_wall_across_its_way : brakes [Wall [(2, -1); (2, 1)]] [] (1 # 16) 2 (head_on (-9) 1) = true
  /\ brakes [Wall [(-(15 # 2), -1); (-(15 # 2), 1)]] [] (1 # 16) 2 (head_on (-9) 1) = false.
Proof. split; vm_compute; reflexivity. Qed.
Example a_pole_at_its_very_distance : brakes [] [((-(6), 0), 1 # 2)] (1 # 16) 2 (head_on (-9) 1) = true
  /\ brakes [] [((-(6), 0), 33 # 64)] (1 # 16) 2 (head_on (-9) 1) = false.
Proof. split; vm_compute; reflexivity. Qed.

(* --- Sweeps: two walkers of a file of tracks, and a third past a square --- *)
Definition walker : trip := {| leave := d 3152519739159347 50; arrive := d 3602879701896397 50; meant := Bezier;
  points := [(d (-5877197513718497) 50, d (-5800636320053199) 55); (d (-658651445502935) 47, d (-3206562934687793) 54)];
  parts := [{| corners := [(d 0 0, d 0 0)]; reach := d 3602879701896397 54 |}] |}.
Definition other_walker : trip := {| leave := d 3152519739159347 50; arrive := d 5854679515581645 50; meant := Bezier;
  points := [(d (-17) 1, d (-5080060379673919) 54); (d (-11) 1, d (-6106881094714393) 54)];
  parts := [{| corners := [(d 0 0, d 0 0)]; reach := d 3602879701896397 54 |}] |}.
Definition between_walkers : list separation :=
  [{| part_no := 0; other_no := 0; since := d 3152519739159347 50; until := d 3602879701896397 50;
      direction := (d 9001076599103277 53, d 5312830578007299 57); width := d 1622551864023849 49 |}].
Definition walkers_never_meet : never_meet walker other_walker.
Proof. apply (sweep_sound _ _ between_walkers). vm_compute. reflexivity. Qed.
Definition wider (more : Q) (m : trip) : trip := {| leave := leave m; arrive := arrive m; meant := meant m; points := points m;
  parts := map (fun p => {| corners := corners p; reach := reach p + more |}) (parts m) |}.
Example wider_ones_might : sweep (wider 3 walker) other_walker between_walkers = false.
Proof. vm_compute. reflexivity. Qed.
Example without_the_last_moment_nothing_is_said : sweep walker other_walker (map (fun s => {| part_no := part_no s; other_no := other_no s;
  since := since s; until := (since s + until s) / 2; direction := direction s; width := width s |}) between_walkers) = false.
Proof. vm_compute. reflexivity. Qed.
Definition passer : trip := {| leave := d 0 0; arrive := d 2 0; meant := Bezier; points := [(d 0 0, d 0 0); (d 3 0, d 1 1)];
  parts := [{| corners := [(d 0 0, d 0 0)]; reach := d 1 2 |}] |}.
Definition square : obstacle := Solid [[(1, 1); (2, 1); (2, 2); (1, 2)]].
Definition past_the_square : list separation :=
  [{| part_no := 0; other_no := 0; since := d 0 0; until := d 2 0;
      direction := (d 5923097743747963 55, d (-8884646615621927) 53); width := d 3671297930057301 53 |};
   {| part_no := 0; other_no := 1; since := d 0 0; until := d 2 0;
      direction := (d 5923097743747963 55, d (-8884646615621927) 53); width := d 3671297930057301 53 |};
   {| part_no := 0; other_no := 2; since := d 0 0; until := d 2 0;
      direction := (d 5923097743747951 55, d (-1110580826952741) 50); width := d 1569493068208893 50 |};
   {| part_no := 0; other_no := 3; since := d 0 0; until := d 2 0;
      direction := (d 5923097743747951 55, d (-1110580826952741) 50); width := d 2576036182996473 52 |}].
Definition it_stays_out : stays_out passer square.
Proof. apply (sweep_past_sound _ _ past_the_square). vm_compute. reflexivity. Qed.
Example with_an_edge_left_out_it_might_not : sweep_past passer square (tl past_the_square) = false.
Proof. vm_compute. reflexivity. Qed.

(* --- Curves: two cubics between rows of a file, as `check --between cubic` certified them; and a spline by hand --- *)
Definition swerving : trip := {| leave := d 0 0; arrive := d 2 0; meant := Bezier;
  points := [(d 0 0, d 0 0); (d 6004799503160661 53, d 0 0);
    (d 5254199565265579 51, d (-1501199875790165) 53); (d 3 0, d 1 1)];
  parts := [{| corners := [(d 0 0, d 0 0)]; reach := d 1 2 |}] |}.
Definition oncoming : trip := {| leave := d 0 0; arrive := d 2 0; meant := Bezier;
  points := [(d 7 1, d (-5) 2); (d 6380099472108203 51, d (-5) 2);
    (d 3752999689475413 51, d (-3) 1); (d 1 0, d (-3) 1)];
  parts := [{| corners := [(d 0 0, d 0 0)]; reach := d 1 2 |}] |}.
Definition between_curves : list separation := [{| part_no := 0; other_no := 0; since := d 0 0; until := d 2 0;
  direction := (d (-76061972311223) 49, d 4462302375591751 52); width := d 411534104346521 49 |}].
Definition curves_never_meet : never_meet swerving oncoming.
Proof. apply (sweep_sound _ _ between_curves). vm_compute. reflexivity. Qed.
Example wider_curves_might : sweep (wider (3 # 4) swerving) oncoming between_curves = false.
Proof. vm_compute. reflexivity. Qed.
(* The parabola (t, t^2), as powers, and the same as a spline and by its control points; a wall at y = -1/2 and one at 1/2. *)
Definition parabola (meant : basis) (points : list point) (reach : Q) : trip :=
  {| leave := 0; arrive := 1; meant := meant; points := points; parts := [{| corners := [(0, 0)]; reach := reach |}] |}.
Definition wall_at (y : Q) : obstacle := Wall [(-1, y); (2, y)].
Definition upward : list separation := [{| part_no := 0; other_no := 0; since := 0; until := 1; direction := (0, 1); width := 0 |}].
Example three_ways_to_write_it : forallb (fun m : Q -> trip => sweep_past (m (31 # 64)) (wall_at (-1 # 2)) upward && negb (sweep_past (m (1 # 2)) (wall_at (-1 # 2)) upward)
    && negb (sweep_past (m 0) (wall_at (1 # 2)) upward))
  [parabola Powers [(0, 0); (1, 0); (0, 1)]; parabola Bezier [(0, 0); (1 # 2, 0); (1, 1)]; parabola Spline [(-1 # 2, 0); (1 # 2, 0); (3 # 2, 2)]] = true.
Proof. vm_compute. reflexivity. Qed.

(* --- Turn: a disc drives an arc to the right past a side of a square, as the monitor certified it --- *)
Definition turner : drive := {| sets_out := d 0 0; halts := d 3602879701896401 51; place_then := (d 0 0, d 0 0);
  heads := (d 494035062339541 49, d 539785169252447 50); turns := d (-3) 2; body_parts := [{| corners := [(d 0 0, d 0 0)]; reach := d 1 2 |}] |}.
Definition left_side : obstacle := Wall [(d 3602879701896397 52, d 3 1); (d 3602879701896397 52, d 3 2)].
Definition past_the_side : list separation := [{| part_no := 0; other_no := 0; since := d 0 0; until := d 3602879701896401 51;
  direction := (d (-6708614116703581) 57, d (-8997434949310831) 53); width := d 5339958565982691 54 |}].
Definition it_drives_clear : drives_clear turner left_side.
Proof. apply (turn_past_sound _ _ past_the_side). vm_compute. reflexivity. Qed.
Definition with_turn (w : Q) (m : drive) : drive :=
  {| sets_out := sets_out m; halts := halts m; place_then := place_then m; heads := heads m; turns := w; body_parts := body_parts m |}.
Example to_the_left_it_would_not : turn_past (with_turn (3 # 4) turner) left_side past_the_side = false.
Proof. vm_compute. reflexivity. Qed.

(* --- Wheels: a TurtleBot3 Burger of 0.105 m, its point 0.08 m ahead, 0.22 m/s, 0.2 s: within 0.1892 m, but not within 0.1891 --- *)
Definition burger : wheels := {| body_reach := 105 # 1000; ahead := 8 # 100; most_speed := 22 # 100; time_step := 1 # 5 |}.
Definition it_stays_within : stays_within burger (Q2R (1892 # 10000)).
Proof. apply wheels_sound. vm_compute. reflexivity. Qed.
Example within_less_it_might_not : wheels_fit burger (1891 # 10000) = false.
Proof. vm_compute. reflexivity. Qed.
